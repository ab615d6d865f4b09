#pragma once
#include <array>
#include <string_view>

#include "drivers/laser/device_clock.h"
#include "drivers/laser/scanner_protocol.h"
#include "drivers/laser/sick_scan.h"

namespace jaywalk::sick {

/// Makes a TiM5xx or LMS1xx send scans: log in as authorised client, first distances of 16 bits and nothing else in
/// each telegram, run, scans on. What is set is not saved in the scanner. Only the last command must be taken; a
/// scanner that refuses another or does not answer it sends scans as it was set before, and that is counted. `dialect`
/// is what is spoken first: a scanner that was never understood is spoken to in the other one on the next connection.
class SickProtocol final : public ScannerProtocol {
 public:
  SickProtocol(Cola dialect, const ScannerModel& model) noexcept;

  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool awaits_answer() const noexcept override { return asked_; }
  [[nodiscard]] bool go_on_unanswered() noexcept override;
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override;

 private:
  struct Step {
    ColaCommand command;
    std::string_view word;  ///< of the command, which its answer repeats
  };

  void speak(Cola dialect) noexcept;
  [[nodiscard]] Heard on_answer(std::string_view body) noexcept;
  /// The command was taken, or not: on to the next. False where it must be taken.
  [[nodiscard]] bool conclude(bool taken) noexcept;
  void count_lost(std::uint16_t telegram_counter) noexcept;

  Cola dialect_;
  ScannerModel model_;
  std::array<Step, 4> steps_;
  std::size_t at_ = 0;  ///< the step that is said next, or whose answer is awaited
  bool asked_ = false;
  bool tried_ = false, understood_ = false;
  ColaStream stream_;
  DeviceClock device_clock_{std::chrono::microseconds(1), std::uint64_t{1} << 32U};
  bool has_counter_ = false;
  std::uint16_t last_counter_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::sick
