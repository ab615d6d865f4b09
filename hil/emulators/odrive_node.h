#pragma once
#include <cstdint>
#include <string_view>

#include "hil/emulators/motor_node.h"

namespace jaywalk::emulators {

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

}  // namespace jaywalk::emulators
