#pragma once
#include <algorithm>
#include <cstdint>
#include <string_view>

#include "drivers/can/can_bus.h"

namespace jaywalk::emulators {

/// `from`, moved towards `to` by `most` at most.
[[nodiscard]] inline double ramped(double from, double to, double most) noexcept {
  return from < to ? std::min(from + most, to) : std::max(from - most, to);
}

/// Parts common to emulated motor controllers on a CAN bus: cable, encoder, and faults to order. In the drive's units.
class MotorNode {
 public:
  /// No more frames out, as when its cable is pulled; frames in are lost too.
  void pull_cable() noexcept { connected_ = false; }
  void plug_cable() noexcept { connected_ = true; }
  /// No more frames out; it goes on hearing and obeying.
  void mute() noexcept { muted_ = true; }
  /// Goes on with the speed that it was told last; everything else is obeyed.
  void stick() noexcept { stuck_ = true; }
  /// Obeys nothing any more, but what it is told feeds its watchdog.
  void go_deaf() noexcept { deaf_ = true; }
  /// What its encoder shows from now on, where a motor of the world's own follows velocity().
  void measure(double velocity, double position) noexcept {
    has_encoder_ = true;
    encoder_velocity_ = velocity;
    encoder_position_ = position;
  }
  /// When it was last told something that feeds its watchdog; kNever before the first time.
  [[nodiscard]] Time heard_controller() const noexcept { return fed_; }

 protected:
  /// `bus` outlives it.
  MotorNode(CanBus& bus, std::uint8_t node) noexcept : bus_(bus), node_(node) {}

  void send(const CanFrame& frame) noexcept {
    if (connected_ && !muted_) static_cast<void>(bus_.send(frame));
  }
  /// Power lost and back: its counter begins at zero.
  void forget() noexcept {
    stuck_ = deaf_ = muted_ = false;
    fed_ = kNever;
    position_ = 0.0;
    encoder_zero_ = encoder_position_;
  }
  [[nodiscard]] double felt_position() const noexcept {
    return has_encoder_ ? encoder_position_ - encoder_zero_ : position_;
  }

  CanBus& bus_;
  std::uint8_t node_;
  bool connected_ = true, muted_ = false, stuck_ = false, deaf_ = false, has_encoder_ = false;
  double position_ = 0.0, encoder_velocity_ = 0.0, encoder_position_ = 0.0, encoder_zero_ = 0.0;
  Time stepped_ = kNever, fed_ = kNever;
};

/// An ODrive axis of firmware 0.6 with a motor that follows its ramp: CANSimple, watchdog, heartbeat and estimates. For
/// tests and the bench; it shares no code with the driver, except how numbers stand in bytes.
class OdriveNode : public MotorNode {
 public:
  /// `bus` outlives it; `node` is 0 to 62.
  OdriveNode(CanBus& bus, std::uint8_t node) noexcept : MotorNode(bus, node) {}

  /// Takes what came in and moves the motor on to `now`.
  void step(Time now) noexcept;

  /// Zero: the watchdog is off, as it comes from the factory.
  void set_watchdog(Duration timeout) noexcept { watchdog_ = timeout; }
  /// It speaks as firmware 0.5: the same messages, other bits of errors.
  void be_of_firmware_05() noexcept { expired_ = 0x800; }
  /// It says that its watchdog expired, and drives on.
  void lie_about_watchdog() noexcept { lies_ = true; }
  /// An error that clearing does not cure while it lasts; 0: it is mended.
  void set_lasting_error(std::uint32_t error) noexcept;
  /// It forgets everything but its settings, as after a loss of power; its encoder counts from zero again.
  void restart() noexcept;
  /// Its position is another one at once, as after an index pulse or a slip of its counter.
  void jump(double turns) noexcept { position_ += turns; }
  /// It never goes to closed loop, and says why by this procedure result.
  void refuse_closed_loop(std::uint8_t procedure) noexcept { procedure_ = procedure; }
  /// It has no encoder messages, as it comes from the factory.
  void withhold_estimates() noexcept { estimates_ = false; }

  [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< turns a second
  [[nodiscard]] double position() const noexcept { return position_; }  ///< turns
  [[nodiscard]] bool is_enabled() const noexcept { return state_ == 8; }
  [[nodiscard]] std::string_view state_name() const noexcept { return is_enabled() ? "enabled" : "off"; }
  /// It lets go until the error is cleared.
  void raise_fault(std::uint32_t error) noexcept { disarm(error); }

 private:
  void take(const CanFrame& frame, Time now) noexcept;
  void watch(Time now) noexcept;
  void disarm(std::uint32_t error) noexcept;
  void move(double seconds) noexcept;
  void say(Time now) noexcept;
  void send(std::uint32_t command, std::uint32_t first, std::uint32_t second) noexcept;

  Duration watchdog_{std::chrono::milliseconds(60)};
  static constexpr Duration kHeartbeatPeriod = std::chrono::milliseconds(10);
  bool lies_ = false, estimates_ = true;
  std::uint32_t expired_ = 0x01000000;  ///< the error of its watchdog
  std::uint32_t lasting_error_ = 0;
  std::uint32_t errors_ = 0;
  std::uint8_t state_ = 1, procedure_ = 0;
  std::uint32_t control_mode_ = 3;  ///< position, as it comes from the factory
  double target_ = 0.0;
  double velocity_ = 0.0;
  Time said_heartbeat_ = kNever, said_estimates_ = kNever;
};

/// A VESC with a motor that follows its ramp (electrical turns): speeds and currents in, status messages 1 and 5 out,
/// settings and fault code when asked, and a timeout. For tests and the bench; it shares no code with the driver,
/// except how numbers stand in bytes.
class VescNode : public MotorNode {
 public:
  /// `bus` outlives it.
  VescNode(CanBus& bus, std::uint8_t controller) noexcept : MotorNode(bus, controller) {}

  /// Takes what came in and moves the motor on to `now`.
  void step(Time now);

  /// As it comes from the factory: 1000 ms and no current.
  void set_timeout(std::uint32_t timeout_ms, float brake_current_a) noexcept;
  /// It tells these settings and keeps to its own.
  void lie_about_timeout(std::uint32_t told_ms) noexcept { told_ms_ = told_ms; }
  /// Its answers have a wrong bit.
  void damage_answers() noexcept { damaged_ = true; }
  void withhold_answers() noexcept { answers_ = false; }
  void withhold_travel() noexcept { tells_travel_ = false; }
  /// 0: mended.
  void set_fault(std::uint8_t code) noexcept { fault_ = code; }
  void set_travel(std::int32_t sixths) noexcept { position_ = sixths / 6.0; }
  /// Its tachometer shows another number at once.
  void jump(double electrical_turns) noexcept { position_ += electrical_turns; }
  /// Minimum ERPM, 900 from the factory: at a lower command, 0 too, it lets its motor go.
  void set_minimum_erpm(double erpm) noexcept { minimum_erpm_ = erpm; }
  /// It forgets everything but its settings, as after a loss of power; its tachometer counts from zero again.
  void restart() noexcept;

  [[nodiscard]] double erpm() const noexcept { return erpm_; }
  [[nodiscard]] double velocity() const noexcept { return erpm_ / 60.0; }  ///< electrical turns a second
  [[nodiscard]] double electrical_turns() const noexcept { return position_; }
  [[nodiscard]] std::string_view state_name() const noexcept;
  void raise_fault(std::uint16_t code) noexcept { fault_ = static_cast<std::uint8_t>(code); }

 private:
  enum class Mode { kSpeed, kCurrent, kBrake };

  void take(const CanFrame& frame, Time now);
  void answer(std::span<const std::uint8_t> question);
  void send_settings(std::uint8_t to);
  void move(double seconds) noexcept;
  void say(Time now) noexcept;
  void send(std::uint32_t command, std::uint8_t id, std::span<const std::uint8_t> bytes) noexcept;

  std::uint32_t timeout_ms_ = 90, told_ms_ = 90;
  float brake_current_a_ = 10.0F;
  bool damaged_ = false, answers_ = true, tells_travel_ = true;
  std::uint8_t fault_ = 0;
  Mode mode_ = Mode::kCurrent;
  double target_erpm_ = 0.0, minimum_erpm_ = 0.0;
  double erpm_ = 0.0;
  Time said_ = kNever;
};

}  // namespace jaywalk::emulators
