#include "planner/motion/twist_ramp.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

double Ramp::toward(double target, double dt_s) noexcept {
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

void Ramp::restart_at(double velocity) noexcept {
  if (velocity == velocity_) return;
  velocity_ = velocity;
  accel_ = 0.0;
}

TwistRamp::TwistRamp(const MotionLimits& limits)
    : forward_(limits.max_accel_mps2, limits.max_jerk_mps3), max_turn_accel_radps2_(limits.max_turn_accel_radps2) {}

Twist2 TwistRamp::toward(const Twist2& target, double dt_s) noexcept {
  const double turn_step = max_turn_accel_radps2_ * dt_s;
  w_radps_ += std::clamp(target.w_radps - w_radps_, -turn_step, turn_step);
  return {forward_.toward(target.v_mps, dt_s), w_radps_};
}

void TwistRamp::follow(const Twist2& permitted) noexcept {
  forward_.restart_at(permitted.v_mps);
  w_radps_ = permitted.w_radps;
}

WheelCommand DiffDrive::wheel_speeds(const Twist2& twist, Time stamp) const noexcept {
  if (!std::isfinite(twist.v_mps) || !std::isfinite(twist.w_radps)) return {.stamp = stamp};
  const double rim_difference = twist.w_radps * drive_.track_width_m / 2.0;
  const double left_radps = (twist.v_mps - rim_difference) / drive_.wheel_radius_m;
  const double right_radps = (twist.v_mps + rim_difference) / drive_.wheel_radius_m;
  const double fastest = std::max(std::fabs(left_radps), std::fabs(right_radps));
  const double slow_by = fastest > drive_.max_wheel_speed_radps ? drive_.max_wheel_speed_radps / fastest : 1.0;
  return {.stamp = stamp, .left_radps = left_radps * slow_by, .right_radps = right_radps * slow_by};
}

}  // namespace jaywalk
