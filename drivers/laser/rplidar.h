#pragma once
// Slamtec's RPLIDAR A series on a serial line: requests A5h and a command, answers A5h 5Ah and their length and type.
#include <array>
#include <cstdint>
#include <optional>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::rplidar {

inline constexpr std::array<std::uint8_t, 2> kStopRequest{0xA5, 0x25}, kScanRequest{0xA5, 0x20};
/// The motor on at 660 of 1023, as the maker's own software has it, and the question how the scanner is.
inline constexpr std::array<std::uint8_t, 8> kMotorOnAndHealth{0xA5, 0xF0, 0x02, 0x94, 0x02, 0xC1, 0xA5, 0x52};

/// What introduces an answer.
struct Descriptor {
  std::uint32_t bytes = 0;  ///< of each part of the answer
  bool repeats = false;     ///< part follows part until it is stopped
  std::uint8_t type = 0;
  bool operator==(const Descriptor&) const = default;
};

inline constexpr std::size_t kDescriptorBytes = 7, kNodeBytes = 5, kHealthBytes = 3;
inline constexpr Descriptor kHealthComes{kHealthBytes, false, 0x06}, kNodesCome{kNodeBytes, true, 0x81};

/// Nothing where the bytes are fewer or do not begin with A5h 5Ah.
[[nodiscard]] std::optional<Descriptor> decode_descriptor(wire::Bytes bytes) noexcept;

/// One measured point.
struct Node {
  bool begins_turn = false;
  std::uint8_t quality = 0;
  double angle_deg = 0.0;  ///< clockwise from ahead, below 360
  float range_m = 0.0F;    ///< 0: the measurement is not valid
};

/// Nothing where the bytes are fewer, their check bits wrong, or the angle more than a turn and 10 degrees.
[[nodiscard]] std::optional<Node> decode_node(wire::Bytes bytes) noexcept;

/// An RPLIDAR A1, A2 or A3 on a serial line (115200 or 256000 baud): stop, motor on, ask how it is, scan. It has no
/// clock and no checksum; points are stamped when they come in, and a turn is handed out as 360 sectors of a degree.
class RplidarProtocol final : public ScannerProtocol {
 public:
  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool awaits_answer() const noexcept override { return step_ == Step::kHealth || step_ == Step::kScan; }
  void hear(wire::Bytes bytes) noexcept override { queue_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {0, skipped_ + queue_.lost(), 0, warned_}; }

 private:
  enum class Step : std::uint8_t { kStop, kPause, kHealth, kAskScan, kScan, kNodes };

  [[nodiscard]] bool find(const Descriptor& wanted) noexcept;
  [[nodiscard]] Heard on_health() noexcept;
  [[nodiscard]] Heard on_nodes(Time arrival, LaserScan& scan) noexcept;
  [[nodiscard]] bool in_step() const noexcept;

  Step step_ = Step::kStop;
  Time stopped_ = kNever;
  bool answer_found_ = false;
  bool lost_step_ = true;  ///< where a node begins is not known
  wire::ByteQueue<8192> queue_;
  TurnBuilder turn_{360, 0.15F, 25.0F};  ///< A1 to A3: nothing below, 12 to 25 m at most (maker's data sheets)
  std::uint64_t skipped_ = 0;
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::rplidar
