#include "planner/motion/diff_drive.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

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
