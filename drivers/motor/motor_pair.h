#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "drivers/can/can_bus.h"
#include "drivers/wired_drive.h"

namespace jaywalk {

/// What one motor is told in a cycle.
enum class MotorOrder : std::uint8_t {
  kOff,   ///< no torque
  kHold,  ///< torque on, speed zero
  kRun,   ///< follow the speed
  kStop   ///< speed zero because of trouble; nothing else that changes its state
};

/// What is known of one motor, in the wheel's units.
struct MotorAxis {
  double turned_rad = 0.0;  ///< since start
  double speed_radps = 0.0;
  bool fresh_position = false, fresh_speed = false;
  bool obeys = false;        ///< its torque is on and it follows speeds
  bool was_enabled = false;  ///< and was asked to
  Time heard = kNever;       ///< of the message that it always sends
};

/// Two motors on one CAN bus that take speeds and watch over the time between commands themselves: what ODrive and VESC
/// have in common. Commands are sent by the tick and by nothing else, so a dead loop is a silent one. At any trouble
/// both are told to stand still, again with every command, until reset() and a command of zero. What motors do or say
/// before they are enabled is no trouble: they have no torque then.
class MotorPair : public WiredDrive {
 public:
  [[nodiscard]] WheelState latest() noexcept override;
  /// A speed that is not finite counts as zero for both.
  void command(const WheelCommand& command) noexcept override;
  [[nodiscard]] DriveTrouble trouble() const noexcept override { return trouble_; }
  void reset() noexcept override;
  [[nodiscard]] bool is_proved() const noexcept override { return armed_; }
  [[nodiscard]] bool is_enabled() const noexcept override;
  void disarm() noexcept override;

 protected:
  /// `bus` and `clock` outlive it. A motor is silent after `silence_limit`; when it is enabled it has `settling` to get
  /// over its fault.
  MotorPair(CanBus& bus, Clock& clock, Duration silence_limit, Duration settling) noexcept
      : bus_(bus), clock_(clock), silence_limit_(silence_limit), settling_(settling) {}

  /// Takes in one frame; keeps its axis up to date.
  virtual void take(const ReceivedFrame& received) noexcept = 0;
  virtual void send_order(std::size_t axis, MotorOrder order, double speed_radps) noexcept = 0;
  /// What makes the motor forget its fault.
  virtual void send_reset(std::size_t axis) noexcept = 0;

  [[nodiscard]] MotorAxis& axis(std::size_t index) noexcept { return axes_[index]; }
  [[nodiscard]] Clock& clock() noexcept { return clock_; }
  void send(const CanFrame& frame) noexcept;
  /// Takes in what waits.
  void receive() noexcept;
  /// Arming: lets a millisecond pass and takes in what came.
  void pass_time();
  /// Arming is done: from now on what goes wrong is trouble.
  void begin_watch() noexcept;
  /// A motor says that something is wrong; it counts once it had time to forget what was before it was enabled.
  void report_fault(DriveTrouble trouble) noexcept;

 private:
  void begin_enabling() noexcept;
  void publish(Time stamp) noexcept;
  void watch() noexcept;
  void latch(DriveTrouble trouble) noexcept;
  [[nodiscard]] MotorOrder order_now() const noexcept;

  CanBus& bus_;
  Clock& clock_;
  Duration silence_limit_, settling_;
  std::array<MotorAxis, 2> axes_;  ///< left, right
  WheelState wheels_;
  DriveTrouble trouble_ = DriveTrouble::kNone;
  bool armed_ = false;
  bool awaits_zero_ = true;
  BusWatch bus_watch_;
  Time settled_ = kNever;
};

/// The difference between two readings of a counter that wraps at 32 bits, as a signed number.
[[nodiscard]] constexpr std::int32_t counted(std::uint32_t from, std::uint32_t to) noexcept {
  return static_cast<std::int32_t>(to - from);
}

}  // namespace jaywalk
