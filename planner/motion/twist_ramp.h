#pragma once
#include <cmath>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// One velocity that follows a target with bounded acceleration and jerk (SAFETY: comfort).
class Ramp {
 public:
  /// Both limits > 0: units/s^2 and units/s^3.
  Ramp(double max_accel, double max_jerk) : max_accel_(max_accel), max_jerk_(max_jerk) {}

  /// The velocity `dt_s` later on the way to `target`. It arrives without overshoot: the acceleration never exceeds
  /// what can still be taken back to zero in the velocity left, sqrt(2 jerk |target - v|).
  double toward(double target, double dt_s) noexcept;
  /// Something else (the supervisor) set the velocity: go on from there.
  void restart_at(double velocity) noexcept;
  [[nodiscard]] double velocity() const noexcept { return velocity_; }

 private:
  double max_accel_;
  double max_jerk_;
  double velocity_ = 0.0;
  double accel_ = 0.0;
};

/// The most, `ahead` of a place, that half of `max_accel` slows to `there` by then: v^2 = there^2 + 2 (a / 2) ahead.
/// The other half is the share of jerk and drives. All 0 or more: m and m/s, or rad and rad/s.
[[nodiscard]] inline double slowing_speed(double there, double ahead, double max_accel) noexcept {
  return std::sqrt(there * there + max_accel * ahead);
}

/// Forward speed with the comfort limits, turning with the turn acceleration limit.
class TwistRamp {
 public:
  explicit TwistRamp(const MotionLimits& limits);
  [[nodiscard]] Twist2 toward(const Twist2& target, double dt_s) noexcept;
  /// What was really permitted last tick; a no-op when it is what was asked for.
  void follow(const Twist2& permitted) noexcept;

 private:
  Ramp forward_;
  double max_turn_accel_radps2_;
  double w_radps_ = 0.0;
};

/// Wheel speeds for a twist: each wheel's rim moves at v -+ w b/2 (b: track width).
/// When a wheel would be faster than the motors can turn, both slow by the same factor, so that the robot keeps its
/// curve and only takes longer. A twist that is not finite gives zero.
class DiffDrive {
 public:
  explicit DiffDrive(const DriveModel& drive) : drive_(drive) {}
  [[nodiscard]] WheelCommand wheel_speeds(const Twist2& twist, Time stamp) const noexcept;

 private:
  DriveModel drive_;
};

}  // namespace jaywalk
