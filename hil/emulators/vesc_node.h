#pragma once
#include <cstdint>
#include <string_view>

#include "hil/emulators/motor_node.h"

namespace jaywalk::emulators {

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
