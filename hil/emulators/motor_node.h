#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/can/can_bus.h"

namespace jaywalk::emulators {

[[nodiscard]] inline double ramped(double from, double to, double most) noexcept {
  return from < to ? std::min(from + most, to) : std::max(from - most, to);
}

/// True once a period: `said` is when it was true last.
[[nodiscard]] inline bool is_due(Time& said, Duration period, Time now) noexcept {
  if (said != kNever && now - said < period) return false;
  said = now;
  return true;
}

/// One wheel's emulated drive of any kind, with faults to order. In its own units, `units_per_rad` of them a radian of
/// the wheel.
class WheelDrive {
 public:
  explicit WheelDrive(double units_per_rad) noexcept : units_per_rad_(units_per_rad) {}
  virtual ~WheelDrive() = default;
  /// Takes what came in and moves the motor on to `now`.
  virtual void step(Time now) = 0;
  [[nodiscard]] virtual double velocity() const noexcept = 0;
  /// rad/s, forward positive, as the drive would have the wheel turn.
  [[nodiscard]] double speed_radps() const noexcept { return velocity() / units_per_rad_; }
  /// What its encoder shows from now on, where a motor of the world's own follows velocity().
  virtual void measure(double velocity, double position) noexcept = 0;
  void measure_wheel(double speed_radps, double turned_rad) noexcept {
    measure(speed_radps * units_per_rad_, turned_rad * units_per_rad_);
  }
  [[nodiscard]] virtual std::string_view state_name() const noexcept = 0;
  /// When it was last told something that feeds its watchdog; kNever before the first time.
  [[nodiscard]] virtual Time heard_controller() const noexcept = 0;
  /// Something broke, and it says so; `code` in its own numbers.
  virtual void raise_fault(std::uint32_t code) noexcept = 0;
  /// No more frames out; frames in are lost too.
  virtual void pull_cable() noexcept = 0;
  virtual void plug_cable() noexcept = 0;
  /// Power lost and back: it forgets everything but its settings, and counts from zero again.
  virtual void restart() noexcept = 0;
  /// Goes on with the speed that it was told last; its watch over the controller works.
  virtual void stick() noexcept = 0;
  /// It obeys, and says nothing of its wheel any more.
  virtual void lose_feedback() noexcept = 0;
  /// Delays the mode that a CiA 402 drive shows after it is enabled; else it shows from the start.
  virtual void show_mode_after_enabling(Duration) noexcept {}
  /// Sets the wheel's speed below which a VESC lets its motor go.
  virtual void let_go_below(double /*speed_radps*/) noexcept {}
  /// Sets the watchdog of an ODrive, or that of a Pioneer's board in its FLASH; zero: off.
  virtual void set_watchdog(Duration) noexcept {}
  virtual void press_stop() noexcept {}

 protected:
  double units_per_rad_;
};

/// Parts common to emulated motor controllers on a CAN bus: cable, encoder, time and faults. For tests and the bench;
/// they share no code with the drivers, except how numbers stand in bytes.
class MotorNode : public WheelDrive {
 public:
  /// `bus` outlives it; `node` is its number there.
  MotorNode(CanBus& bus, std::uint8_t node, double units_per_rad = 1.0) noexcept
      : WheelDrive(units_per_rad), bus_(bus), node_(node) {}

  void step(Time now) override;
  void pull_cable() noexcept override { connected_ = false; }
  void plug_cable() noexcept override { connected_ = true; }
  /// No more frames out; it goes on hearing and obeying.
  void mute() noexcept { muted_ = true; }
  void lose_feedback() noexcept override { mute(); }
  void stick() noexcept override { stuck_ = true; }
  /// Obeys nothing any more, but what it is told feeds its watchdog.
  void go_deaf() noexcept { deaf_ = true; }
  /// Its position is another one at once, as after an index pulse or a slip of its counter.
  void jump(double units) noexcept { position_ += units; }
  void measure(double velocity, double position) noexcept override {
    has_encoder_ = true;
    encoder_velocity_ = velocity;
    encoder_position_ = position;
  }
  [[nodiscard]] double velocity() const noexcept override { return velocity_; }
  [[nodiscard]] double position() const noexcept { return position_; }
  [[nodiscard]] bool is_enabled() const noexcept { return state_name() == "enabled"; }
  [[nodiscard]] Time heard_controller() const noexcept override { return fed_; }

 protected:
  virtual void take(const CanFrame& frame, Time now) = 0;
  virtual void watch(Time now) noexcept = 0;
  virtual void move(double seconds) noexcept = 0;
  virtual void say(Time now) noexcept = 0;

  void send(const CanFrame& frame) noexcept {
    if (connected_ && !muted_) static_cast<void>(bus_.send(frame));
  }
  void forget() noexcept {
    stuck_ = deaf_ = muted_ = false;
    fed_ = kNever;
    position_ = 0.0;
    encoder_zero_ = encoder_position_;
  }
  [[nodiscard]] double felt_position() const noexcept {
    return has_encoder_ ? encoder_position_ - encoder_zero_ : position_;
  }
  [[nodiscard]] double felt_velocity() const noexcept { return has_encoder_ ? encoder_velocity_ : velocity(); }

  CanBus& bus_;
  std::uint8_t node_;
  bool connected_ = true, muted_ = false, stuck_ = false, deaf_ = false, has_encoder_ = false;
  double velocity_ = 0.0, position_ = 0.0, encoder_velocity_ = 0.0, encoder_position_ = 0.0, encoder_zero_ = 0.0;
  Time stepped_ = kNever, fed_ = kNever;
};

/// An ODrive axis of firmware 0.6 with a motor that follows its ramp: CANSimple, watchdog, heartbeat and estimates. In
/// turns; its node is 0 to 62.
class OdriveNode final : public MotorNode {
 public:
  using MotorNode::MotorNode;

  /// Zero: the watchdog is off, as it comes from the factory.
  void set_watchdog(Duration timeout) noexcept override { watchdog_ = timeout; }
  /// It speaks as firmware 0.5: the same messages, other bits of errors.
  void be_of_firmware_05() noexcept { expired_ = 0x800; }
  /// It says that its watchdog expired, and drives on.
  void lie_about_watchdog() noexcept { lies_ = true; }
  /// An error that clearing does not cure while it lasts; 0: it is mended.
  void set_lasting_error(std::uint32_t error) noexcept;
  void restart() noexcept override;
  /// It never goes to closed loop, and says why by this procedure result.
  void refuse_closed_loop(std::uint8_t procedure) noexcept { procedure_ = procedure; }
  /// It has no encoder messages, as it comes from the factory.
  void withhold_estimates() noexcept { estimates_ = false; }

  [[nodiscard]] std::string_view state_name() const noexcept override { return state_ == 8 ? "enabled" : "off"; }
  /// It lets go until the error is cleared.
  void raise_fault(std::uint32_t error) noexcept override { disarm(error); }

 private:
  void take(const CanFrame& frame, Time now) noexcept override;
  void watch(Time now) noexcept override;
  void disarm(std::uint32_t error) noexcept;
  void move(double seconds) noexcept override;
  void say(Time now) noexcept override;
  void send(std::uint32_t command, std::uint32_t first, std::uint32_t second) noexcept;

  Duration watchdog_{std::chrono::milliseconds(60)};
  bool lies_ = false, estimates_ = true;
  std::uint32_t expired_ = 0x01000000;  ///< the error of its watchdog
  std::uint32_t lasting_error_ = 0;
  std::uint32_t errors_ = 0;
  std::uint8_t state_ = 1, procedure_ = 0;
  std::uint32_t control_mode_ = 3;  ///< position, as it comes from the factory
  double target_ = 0.0;
  Time said_heartbeat_ = kNever, said_estimates_ = kNever;
};

/// A VESC with a motor that follows its ramp: speeds and currents in, status messages 1 and 5 out, settings and fault
/// code when asked, and a timeout. In electrical turns.
class VescNode final : public MotorNode {
 public:
  using MotorNode::MotorNode;

  /// As it comes from the factory: 1000 ms and no current.
  void set_timeout(std::uint32_t timeout_ms, float brake_current_a) noexcept;
  /// It tells these settings and keeps to its own.
  void lie_about_timeout(std::uint32_t told_ms) noexcept { told_ms_ = told_ms; }
  void damage_answers() noexcept { damaged_ = true; }
  void withhold_answers() noexcept { answers_ = false; }
  void withhold_travel() noexcept { tells_travel_ = false; }
  void set_travel(std::int32_t sixths) noexcept { position_ = sixths / 6.0; }
  /// Minimum ERPM, 900 from the factory: at a lower command, 0 too, it lets its motor go.
  void set_minimum_erpm(double erpm) noexcept { minimum_erpm_ = erpm; }
  void let_go_below(double speed_radps) noexcept override {
    set_minimum_erpm(60.0 * speed_radps * std::fabs(units_per_rad_));
  }
  void restart() noexcept override;

  [[nodiscard]] double erpm() const noexcept { return erpm_; }
  [[nodiscard]] double velocity() const noexcept override { return erpm_ / 60.0; }
  [[nodiscard]] std::string_view state_name() const noexcept override;
  /// 0: mended.
  void raise_fault(std::uint32_t code) noexcept override { fault_ = static_cast<std::uint8_t>(code); }

 private:
  enum class Mode { kSpeed, kCurrent, kBrake };

  void take(const CanFrame& frame, Time now) override;
  void watch(Time now) noexcept override;
  void answer(std::span<const std::uint8_t> question);
  void send_settings(std::uint8_t to);
  void move(double seconds) noexcept override;
  void say(Time now) noexcept override;
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
