#pragma once
// Hokuyo's SCIP 2.0: lines of text, six bits a character, a checksum a line.
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::scip {

/// The character that ends a line: the sum's low six bits, moved up by 30h.
[[nodiscard]] char checksum(std::string_view line) noexcept;
/// The number that 1 to 5 characters hold, six bits each, highest first; nothing where one is outside 30h to 6Fh.
[[nodiscard]] std::optional<std::uint32_t> decode_number(std::string_view characters) noexcept;

/// Cuts a stream into answers: lines that end at an empty one. 2048 beams of three characters, and their lines, are
/// 6.4 kB.
struct AnswerStream : wire::ByteQueue<16384> {
  /// The next whole answer without its empty line; valid until the next append.
  [[nodiscard]] std::optional<std::string_view> next() noexcept;
};

/// What a scanner tells about itself in its answer to PP.
struct ScannerModel {
  std::uint32_t steps_per_turn = 1440;
  std::uint32_t front_step = 540;  ///< the step that looks straight ahead
  std::uint32_t first_step = 0;
  std::uint32_t last_step = 1080;
  float range_min_m = 0.1F;
  float range_max_m = 30.0F;
  Duration period = std::chrono::milliseconds(25);
  /// The code 1 is "no object in the range", as of the UTM-30LX; others say weak light by it (C-42-03320B, 6).
  bool one_means_nothing = false;
};

/// Reads the answer to PP: lines "DMIN:20;4", the last character the checksum of what stands before the semicolon.
/// False for any other answer, and for one with a value that no scanner has, or without one that is needed.
[[nodiscard]] bool decode_model(std::string_view answer, ScannerModel& model) noexcept;

/// Decodes an answer to MD, MS, GD or GS (distances of the first echo) into `scan`, all but its sequence.
///
/// `arrival` is when its last byte came in; the scan's stamp is that less the sweep: how long the scanner and the
/// line held it is not known here. Distances below range_min_m are the scanner's error codes: they prove nothing but
/// the one by which a UTM-30LX says that it found nothing. Nor does 65533, which newer models say for nothing in range
/// as well as for too little light. `device_time_ms` is the scanner's own clock, 24 bits.
[[nodiscard]] Heard decode_scan(std::string_view answer, const ScannerModel& model, Time arrival, LaserScan& scan,
                                std::uint32_t& device_time_ms) noexcept;

/// Makes a Hokuyo of SCIP 2.0 or 2.2 send scans, over TCP (port 10940) or a serial line: have it speak SCIP 2.0, as a
/// URG-04LX does not from the start, stop what it may still be sending, ask what it is, laser on, all its steps in
/// three characters each for ever. Where it has more steps than a scan may have beams, it joins neighbours, of which
/// the nearest counts.
class ScipProtocol final : public ScannerProtocol {
 public:
  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  /// True at SCIP2.0, the command that chooses the protocol: scanners that always speak it may not know the command.
  [[nodiscard]] bool go_on_unanswered() noexcept override;
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {lost_, skipped_ + stream_.skipped(), 0, 0}; }

 private:
  enum class Step : std::uint8_t { kDialect, kQuiet, kAsk, kLaserOn, kScans, kDone };

  void write_command() noexcept;
  void go_on() noexcept;
  [[nodiscard]] Heard on_answer(std::string_view answer) noexcept;
  [[nodiscard]] Heard on_scan(std::string_view answer, Time arrival, LaserScan& scan) noexcept;
  void count_lost(std::uint32_t device_time_ms) noexcept;

  Step step_ = Step::kDialect;
  std::array<char, 20> command_{};
  std::string_view said_;  ///< the command without its end, which answers repeat
  ScannerModel model_;
  AnswerStream stream_;
  DeviceClock device_clock_{std::chrono::milliseconds(1), kClockTicks};
  std::optional<std::uint32_t> last_time_ms_;
  std::uint64_t lost_ = 0;
  std::uint64_t skipped_ = 0;

  static constexpr std::uint32_t kClockTicks = 1U << 24U;  ///< four characters of six bits
};

}  // namespace jaywalk::scip
