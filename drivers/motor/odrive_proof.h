#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/motor/motor_axis.h"
#include "drivers/motor/odrive.h"

namespace jaywalk::odrive {

/// What one axis said last.
struct AxisReport {
  Time heard = kNever;    ///< of its heartbeat
  Time expired = kNever;  ///< of the first heartbeat with the watchdog's error; kNever while it has none
  std::uint32_t errors = 0;
  std::uint8_t state = 0;      ///< AxisState where it is one of those
  std::uint8_t procedure = 0;  ///< ProcedureResult
  double speed_radps = 0.0;
};

struct ProofLimits {
  Duration watchdog_least{}, watchdog_most{};  ///< from the last command to the error
};

/// Whether an axis lets go by itself when nobody commands it: idle, velocity mode, no errors; then it holds speed zero
/// under torque, is left without commands, and must say in time that its watchdog expired and that it let go.
///
/// `step` returns the frames that are due; nothing else may be sent to the axis meanwhile, as everything feeds its
/// watchdog. Firmware 0.6 tells its controller mode only by numbers that differ from version to version, so the mode is
/// set here and at each enabling, and not read back; a wheel that turns fails the proof.
class WatchdogProof {
 public:
  /// Of the axis `node`; the first frames are due at once.
  void begin(std::uint8_t node, const ProofLimits& limits, Time now) noexcept;
  [[nodiscard]] std::span<const CanFrame> step(Time now, const AxisReport& axis) noexcept;
  [[nodiscard]] ProofResult result() const noexcept { return result_; }
  /// "watchdog: expired 66 ms after the last command"; allocates.
  [[nodiscard]] std::string line() const;
  /// Remedy where it is not proved; allocates.
  [[nodiscard]] std::string remedy() const;

 private:
  enum class Stage : std::uint8_t { kBegin, kClear, kClose, kWithhold, kDone };
  enum class Verdict : std::uint8_t {
    kNone,
    kSilent,
    kDoesNotClear,
    kTurns,
    kDoesNotClose,
    kNothingSaid,
    kOldFirmware,
    kHoldsOn,
    kHasty,
    kLate
  };

  /// It was heard since this stage began.
  [[nodiscard]] bool was_heard(const AxisReport& axis) const noexcept { return axis.heard > since_; }
  void clear(Time now, const AxisReport& axis) noexcept;
  void close(Time now, const AxisReport& axis) noexcept;
  void withhold(Time now, const AxisReport& axis) noexcept;
  void enter(Stage stage, Time now) noexcept;
  /// Says zero now and then, as long as the watchdog is to be fed.
  void feed(Time now) noexcept;
  void finish(ProofResult result, Verdict verdict) noexcept;
  void add(const CanFrame& frame) noexcept { due_[due_count_++] = frame; }

  std::uint8_t node_ = 0;
  ProofLimits limits_;
  Stage stage_ = Stage::kDone;
  Time since_ = kNever, fed_ = kNever;
  ProofResult result_ = ProofResult::kFailed;
  Verdict verdict_ = Verdict::kNone;
  std::uint32_t errors_ = 0;
  std::uint8_t procedure_ = 0;
  Duration after_{};  ///< from the last command to what was seen then
  std::array<CanFrame, 4> due_;
  std::size_t due_count_ = 0;
};

/// "01000000h (watchdog expired)", "00000000h".
[[nodiscard]] std::string error_words(std::uint32_t errors);

}  // namespace jaywalk::odrive
