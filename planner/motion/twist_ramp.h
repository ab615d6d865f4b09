#pragma once
#include <algorithm>
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
  double toward(double target, double dt_s) noexcept {
    const double left = std::fabs(target - velocity_);
    const double accel_step = max_jerk_ * dt_s;
    // Coming down from acceleration a by one step a tick covers dt (a^2 / (2 step) + a / 2): the largest a for what is
    // left.
    const double landing = accel_step * (std::sqrt(0.25 + 2.0 * left / (accel_step * dt_s)) - 0.5);
    const double size = std::min({max_accel_, landing, left / dt_s});
    accel_ += std::clamp((target < velocity_ ? -size : size) - accel_, -accel_step, accel_step);
    velocity_ += accel_ * dt_s;
    if (std::fabs(target - velocity_) < 1e-12) velocity_ = target;  // what rounding leaves
    return velocity_;
  }
  /// Something else (the supervisor) set the velocity: go on from there.
  void restart_at(double velocity) noexcept {
    if (velocity == velocity_) return;
    velocity_ = velocity;
    accel_ = 0.0;
  }
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
  explicit TwistRamp(const MotionLimits& limits)
      : forward_(limits.max_accel_mps2, limits.max_jerk_mps3), max_turn_accel_radps2_(limits.max_turn_accel_radps2) {}
  [[nodiscard]] Twist2 toward(const Twist2& target, double dt_s) noexcept {
    const double turn_step = max_turn_accel_radps2_ * dt_s;
    w_radps_ += std::clamp(target.w_radps - w_radps_, -turn_step, turn_step);
    return {forward_.toward(target.v_mps, dt_s), w_radps_};
  }
  /// What was really permitted last tick; a no-op when it is what was asked for.
  void follow(const Twist2& permitted) noexcept {
    forward_.restart_at(permitted.v_mps);
    w_radps_ = permitted.w_radps;
  }

 private:
  Ramp forward_;
  double max_turn_accel_radps2_;
  double w_radps_ = 0.0;
};

/// Wheel speeds for a twist: each wheel's rim moves at v -+ w b/2 (b: track width).
/// When a wheel would be faster than the motors can turn, both slow by the same factor, so that the robot keeps its
/// curve and only takes longer. A twist that is not finite gives zero.
[[nodiscard]] inline WheelCommand wheel_speeds(const DriveModel& drive, const Twist2& twist, Time stamp) noexcept {
  if (!std::isfinite(twist.v_mps) || !std::isfinite(twist.w_radps)) return {.stamp = stamp};
  const double rim_difference = twist.w_radps * drive.track_width_m / 2.0;
  const double left_radps = (twist.v_mps - rim_difference) / drive.wheel_radius_m;
  const double right_radps = (twist.v_mps + rim_difference) / drive.wheel_radius_m;
  const double fastest = std::max(std::fabs(left_radps), std::fabs(right_radps));
  const double slow_by = fastest > drive.max_wheel_speed_radps ? drive.max_wheel_speed_radps / fastest : 1.0;
  return {.stamp = stamp, .left_radps = left_radps * slow_by, .right_radps = right_radps * slow_by};
}

}  // namespace jaywalk
