#pragma once
// The simulated robot's motors, wheels and body.
#include <cstdint>

#include "hal/sim/random.h"
#include "hal/sim/scenario.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk::sim {

/// Motor speed follows the command with this time constant (s) ...
inline constexpr double kMotorLag = 0.05;
/// ... but gains or loses no more than this share of the drive's proved braking.
inline constexpr double kAccelOverBrake = 1.5;
/// Slip is correlated over this time (s).
inline constexpr double kSlipTime = 1.0;
/// A wheel that has lost its grip (fault wheel_slip) moves the robot by this share of what it turns.
inline constexpr double kLostGrip = 0.4;
/// 500 lines, four edges a line, gear 38.3 to 1: the encoders of a P3-DX.
inline constexpr double kTicksPerTurn = 76600.0;
/// Without a command for this long the drive stops itself.
inline constexpr Duration kDriveWatchdog{100'000'000};

/// How motors, encoders and wheels are connected; the default is right.
struct Miswiring {
  double left_motor = 1.0;   ///< -1: turns the other way than commanded, and its encoder says so
  double right_motor = 1.0;  ///< likewise
  double left_ground = 1.0;  ///< -1: motor and encoder both the other way round
  bool swapped = false;      ///< the left drive turns the right wheel, and the right one the left
  bool left_stuck = false;   ///< its motor does not turn
};

/// A differential drive: two motors with lag, saturation and bounded acceleration, wheels that slip a little, encoders.
class Plant {
 public:
  Plant(const RobotModel& model, const Pose2& start, std::uint64_t seed, const SlipSpec& slip = {},
        const TrueRobot& truth = {});

  /// A command that is not finite is no command.
  void command(const WheelCommand& command, Time now) noexcept {
    if (!std::isfinite(command.left_radps) || !std::isfinite(command.right_radps)) return;
    left_.wanted = wiring_.left_motor * std::clamp(command.left_radps, -max_speed_, max_speed_);
    right_.wanted = wiring_.right_motor * std::clamp(command.right_radps, -max_speed_, max_speed_);
    commanded_ = now;
  }
  /// Moves on by `step_s` (s), at most about 5 ms; `now` is the step's end.
  void step(double step_s, Time now) noexcept;
  /// Draws new slip, `step_s` since the last time: an Ornstein-Uhlenbeck process, sampled exactly, so that it keeps its
  /// standard deviation whatever the step.
  void change_slip(double step_s) noexcept {
    const double kept = exp(-step_s / kSlipTime);
    const double fresh = slip_.std * std::sqrt(1.0 - kept * kept);
    left_.slip = kept * left_.slip + fresh * random_.normal();
    right_.slip = kept * right_.slip + fresh * random_.normal();
  }
  /// What share of its turning each wheel moves the robot by.
  void grip(double left, double right) noexcept { left_.grip = left, right_.grip = right; }
  void connect(const Miswiring& wiring) noexcept { wiring_ = wiring; }
  /// A person lifts the robot: nothing turns its wheels, and whatever they do moves nothing.
  void carry_to(const Pose2& pose) noexcept { map_from_robot_ = pose; }
  /// Something solid is in the way: body and wheels stand, the body at `pose`.
  void stop_at(const Pose2& pose) noexcept {
    map_from_robot_ = pose;
    twist_ = {};
    left_.speed = right_.speed = 0.0;
  }
  /// Reads the encoders: whole ticks as angles, and speeds from the ticks counted since the last reading.
  [[nodiscard]] WheelState read_encoders(Time now) noexcept;

  [[nodiscard]] const Pose2& map_from_robot() const noexcept { return map_from_robot_; }
  [[nodiscard]] const Twist2& twist() const noexcept { return twist_; }
  /// Mean speed (m/s) at the wheels' rims: forward speed without slip.
  [[nodiscard]] double rim_speed() const noexcept {
    return 0.5 * (left_.radius_m * left_.speed + right_.radius_m * right_.speed);
  }

 private:
  struct Wheel {
    double radius_m;
    double grip = 1.0;
    double wanted = 0.0;  ///< rad/s
    double speed = 0.0;   ///< rad/s
    double angle = 0.0;   ///< rad
    double slip = 0.0;    ///< share of its speed that the ground does not see, beyond the mean
  };
  /// Turns the wheel for one step and returns the way (m) that the ground passes.
  double turn(Wheel& wheel, double step_s, bool alive) const noexcept;

  double track_m_, max_speed_, max_accel_;
  SlipSpec slip_;
  Pose2 map_from_robot_;
  Twist2 twist_;
  Wheel left_, right_;
  Miswiring wiring_;
  Time commanded_ = kNever;
  WheelState reading_;
  Random random_;
};

}  // namespace jaywalk::sim
