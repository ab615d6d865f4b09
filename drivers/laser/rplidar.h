#pragma once
// Slamtec's RPLIDAR A series on a serial line: requests A5h and a command, answers A5h 5Ah and their length and type.
#include <cstdint>
#include <optional>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::rplidar {

/// One measured point.
struct Node {
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
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {0, queue_.skipped(), 0, warned_}; }

 private:
  enum class Step : std::uint8_t { kStop, kPause, kHealth, kAskScan, kScan, kNodes };

  [[nodiscard]] bool find(wire::Bytes descriptor) noexcept;
  [[nodiscard]] Heard on_health() noexcept;
  [[nodiscard]] Heard on_nodes(Time arrival, LaserScan& scan) noexcept;
  [[nodiscard]] bool in_step() const noexcept;

  Step step_ = Step::kStop;
  Time stopped_ = kNever;
  bool answer_found_ = false;
  bool lost_step_ = true;  ///< where a node begins is not known
  wire::ByteQueue<8192> queue_;
  TurnBuilder turn_{360, 0.15F, 25.0F};  ///< A1 to A3: nothing below, 12 to 25 m at most (maker's data sheets)
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::rplidar
