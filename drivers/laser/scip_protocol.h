#pragma once
#include <array>
#include <string_view>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/laser/scip.h"

namespace jaywalk::scip {

/// Makes a Hokuyo of SCIP 2.0 or 2.2 send scans, over TCP (port 10940) or a serial line: have it speak SCIP 2.0, as a
/// URG-04LX does not from the start, stop what it may still be sending, ask what it is, laser on, all its steps in
/// three characters each for ever. Where it has more steps than a scan may have beams, it joins neighbours, of which
/// the nearest counts.
class ScipProtocol final : public ScannerProtocol {
 public:
  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool awaits_answer() const noexcept override { return asked_; }
  /// True at SCIP2.0, the command that chooses the protocol: scanners that always speak it may not know the command.
  [[nodiscard]] bool go_on_unanswered() noexcept override;
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {lost_, skipped_ + stream_.lost(), 0, 0}; }

 private:
  enum class Step : std::uint8_t { kDialect, kQuiet, kAsk, kLaserOn, kScans, kDone };

  void write_command() noexcept;
  void go_on() noexcept;
  [[nodiscard]] Heard on_answer(std::string_view answer) noexcept;
  [[nodiscard]] Heard on_scan(std::string_view answer, Time arrival, LaserScan& scan) noexcept;
  void count_lost(std::uint32_t device_time_ms) noexcept;

  Step step_ = Step::kDialect;
  bool asked_ = false;
  std::array<char, 20> command_{};
  std::string_view said_;  ///< the command without its end, which answers repeat
  ScannerModel model_;
  AnswerStream stream_;
  DeviceClock device_clock_{std::chrono::milliseconds(1), kClockTicks};
  bool has_time_ = false;
  std::uint32_t last_time_ms_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t skipped_ = 0;

  static constexpr std::uint32_t kClockTicks = 1U << 24U;  ///< four characters of six bits
};

}  // namespace jaywalk::scip
