#pragma once
// ODrive's CANSimple messages (firmware 0.6): identifier node * 32 + command, floats least significant byte first.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "drivers/can/can_bus.h"
#include "drivers/motor/motor_pair.h"
#include "drivers/wired_drive.h"

namespace jaywalk::odrive {

/// States of an axis: closed loop obeys speeds, idle lets go.
inline constexpr std::uint8_t kIdle = 1, kClosedLoop = 8;

/// Bits of Heartbeat::active_errors that arming looks at; any other bit is an error too.
inline constexpr std::uint32_t kWatchdogExpired = 0x01000000, kEstopRequested = 0x02000000;

/// The watchdog's error in firmware 0.5 (AXIS_ERROR). That firmware sends the same messages but numbers its errors
/// otherwise.
inline constexpr std::uint32_t kWatchdogExpired05 = 0x00000800;

/// `node` is 0 to 62; `state` kIdle or kClosedLoop.
[[nodiscard]] CanFrame set_axis_state(std::uint8_t node, std::uint8_t state) noexcept;
/// Velocity control; `ramped` limits its change by the axis' own setting.
[[nodiscard]] CanFrame set_velocity_mode(std::uint8_t node, bool ramped) noexcept;
/// Turns of the motor a second, forward positive. Every such frame feeds the watchdog.
[[nodiscard]] CanFrame set_velocity(std::uint8_t node, float turns_per_s) noexcept;
[[nodiscard]] CanFrame emergency_stop(std::uint8_t node) noexcept;
[[nodiscard]] CanFrame clear_errors(std::uint8_t node) noexcept;

struct Heartbeat {
  std::uint32_t active_errors = 0;
  std::uint8_t axis_state = 0;  ///< kIdle, kClosedLoop or another
  std::uint8_t procedure = 0;   ///< how the last change of state went: ProcedureResult
};

struct EncoderEstimates {
  float position_turns = 0.0F;  ///< finite
  float velocity_turns_per_s = 0.0F;
};

struct Message {
  std::uint8_t node = 0;
  std::variant<Heartbeat, EncoderEstimates> content;
};

/// Whether `frame` is one that only a controller sends to `node`: a command that sets something, or a request. Any of
/// them feeds the axis' watchdog.
[[nodiscard]] bool is_order(const CanFrame& frame, std::uint8_t node) noexcept;

/// Nothing where `frame` is none of these, is too short, or holds a number that is not finite.
[[nodiscard]] std::optional<Message> decode(const CanFrame& frame) noexcept;

/// What one axis said last.
struct AxisReport {
  Time heard = kNever;    ///< of its heartbeat
  Time expired = kNever;  ///< of the first heartbeat with the watchdog's error; kNever while it has none
  std::uint32_t errors = 0;
  std::uint8_t state = 0, procedure = 0;  ///< as in Heartbeat
  double speed_radps = 0.0;
};

/// Whether an axis lets go by itself when nobody commands it: idle, velocity mode, no errors; then it holds speed zero
/// under torque, is left without commands, and must say in time that its watchdog expired and that it let go.
///
/// `step` returns the frames that are due; nothing else may be sent to the axis meanwhile, as everything feeds its
/// watchdog. Firmware 0.6 tells its controller mode only by numbers that differ from version to version, so the mode is
/// set here and at each enabling, and not read back; a wheel that turns fails the proof.
class WatchdogProof {
 public:
  /// Begins the proof of axis `node`: its watchdog must expire `least` to `most` after the last command. The first
  /// frames are due at once.
  void begin(std::uint8_t node, Duration least, Duration most, Time now) noexcept;
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
  [[nodiscard]] bool was_heard() const noexcept { return axis_.heard > since_; }
  /// It says that it is in `state` without errors; fed until then, and given up as `otherwise` after a time.
  [[nodiscard]] bool reaches(std::uint8_t state, Time now, Verdict otherwise) noexcept;
  void begin_clearing(Time now) noexcept;
  void clear(Time now) noexcept;
  void close(Time now) noexcept;
  void withhold(Time now) noexcept;
  void enter(Stage stage, Time now) noexcept;
  /// Says zero now and then, as long as the watchdog is to be fed.
  void feed(Time now) noexcept;
  void finish(ProofResult result, Verdict verdict) noexcept;
  void add(const CanFrame& frame) noexcept { due_[due_count_++] = frame; }

  std::uint8_t node_ = 0;
  Duration least_{}, most_{};
  AxisReport axis_;
  Stage stage_ = Stage::kDone;
  Time since_ = kNever, fed_ = kNever;
  ProofResult result_ = ProofResult::kFailed;
  Verdict verdict_ = Verdict::kNone;
  Duration after_{};  ///< from the last command to what was seen then
  std::array<CanFrame, 4> due_;
  std::size_t due_count_ = 0;
};

/// "01000000h (watchdog expired)", "00000000h".
[[nodiscard]] std::string error_words(std::uint32_t errors);

struct BaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: turns of the motor a radian of the wheel
  /// A watchdog that did not show itself so long after the last command is not proved. The heartbeat that shows it adds
  /// to what the watchdog takes: heartbeat_msg_rate_ms of 10 and watchdog_timeout of 0.06 fit.
  Duration watchdog_limit = std::chrono::milliseconds(100);
  Duration watchdog_least = std::chrono::milliseconds(40);  ///< it must outlast two commands
  Duration silence_limit = std::chrono::milliseconds(150);  ///< without a heartbeat
  StopLimits stop;                                          ///< braking and tolerance must be given
  bool allow_unproved = false;  ///< arms although an axis did not show that it stops by itself
};

/// Two axes of ODrives of firmware 0.6 in velocity control, ramped by their own vel_ramp_rate.
///
/// Arming proof: WatchdogProof, of one axis after the other, before the first command and after every return. An
/// ODrive does not brake its wheel when its watchdog expires or when it is set idle: the wheel coasts.
class OdriveBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  OdriveBase(CanBus& bus, Clock& clock, const BaseSetup& setup);
  [[nodiscard]] std::string inspect(std::size_t side) override;

 private:
  struct Seen {
    AxisReport said;
    FrameRate heartbeats = {};
    float position_turns = 0.0F;
  };

  void take(const ReceivedFrame& received) noexcept override;
  void take_heartbeat(std::size_t index, const Heartbeat& heartbeat, Time stamp) noexcept;
  void take_estimates(std::size_t index, const EncoderEstimates& estimates, Time stamp) noexcept;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  void send_reset(std::size_t index) noexcept override;
  void begin_proof(std::size_t index) noexcept override {
    proofs_[index].begin(setup_.axes[index].node, setup_.watchdog_least, setup_.watchdog_limit, clock().now());
  }
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] std::string proof_line(std::size_t index) const override { return who(index) + proofs_[index].line(); }
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override { return proofs_[index].remedy(); }
  [[nodiscard]] StartupError absence(std::size_t index) const override;
  [[nodiscard]] std::string who(std::size_t index) const {
    return "ODrive node " + std::to_string(setup_.axes[index].node) + ": ";
  }

  BaseSetup setup_;
  std::array<Seen, 2> seen_;
  std::array<WatchdogProof, 2> proofs_;
};

}  // namespace jaywalk::odrive
