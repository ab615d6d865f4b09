#include "planner/motion/follower.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kLookAhead_m = 0.35;          // at rest; half a robot's length
constexpr double kLookAhead_s = 0.7;           // plus so much travel
constexpr double kTurnInPlaceAbove_rad = 1.0;  // looking further away than this, turn before driving
constexpr double kTurnGain_per_s = 2.0;        // turn in place at this rate a radian of error
constexpr double kLateralAccel_mps2 = 0.5;     // comfort in curves, as ahead
constexpr double kStopWithin = 1.0 / 3.0;      // of the tolerance: close enough to stand still

}  // namespace

Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (distance(path[i], robot) < distance(path[nearest], robot)) nearest = i;
  }
  for (std::size_t i = nearest; i + 1 < path.size(); ++i) {
    const double piece = distance(path[i], path[i + 1]);
    if (piece > ahead_m) return path[i] + (path[i + 1] - path[i]) * (ahead_m / piece);
    ahead_m -= piece;
  }
  return path.back();
}

Follower::Follower(const FollowerConfig& config)
    : config_(config),
      speed_choice_{.robot_radius_m = config.robot_radius_m,
                    .max_speed_mps = config.limits.max_speed_mps,
                    .max_accel_mps2 = config.limits.max_accel_mps2},
      ramp_(config.limits) {}

Twist2 Follower::twist(const FollowerInput& input) noexcept {
  ramp_.follow(input.permitted_before);
  return ramp_.toward(wish(input), config_.tick_s);
}

Twist2 Follower::wish(const FollowerInput& input) noexcept {
  const double cruise = config_.constant_speed && input.has_goal ? config_.limits.max_speed_mps : 0.0;
  if (input.path.empty() || !input.has_goal) return {cruise, 0.0};
  const Vec2 robot = input.map_from_robot.position();
  if (cruise == 0.0 && distance(robot, input.goal_in_map) < config_.goal_tolerance_m * kStopWithin) return {};

  const double v_now = std::max(input.permitted_before.v_mps, 0.0);
  const Vec2 target =
      inverse(input.map_from_robot) * look_ahead(input.path, robot, kLookAhead_m + kLookAhead_s * v_now);
  const double bearing = atan2(target.y, target.x);
  const double turn =
      std::clamp(kTurnGain_per_s * bearing, -config_.limits.max_turn_radps, config_.limits.max_turn_radps);
  if (std::fabs(bearing) > kTurnInPlaceAbove_rad) return {cruise, turn};
  // Pure pursuit: the circle through here and the target that is tangent to the heading has curvature 2 y / d^2.
  const double curvature = 2.0 * target.y / std::max(dot(target, target), 1e-6);
  const double v = cruise > 0.0 ? cruise : speed_for(input, curvature);
  const double w =
      std::clamp(curvature * std::max(v, v_now), -config_.limits.max_turn_radps, config_.limits.max_turn_radps);
  return {v, w};
}

double Follower::speed_for(const FollowerInput& input, double curvature_per_m) const noexcept {
  const Vec2 robot = input.map_from_robot.position();
  const double bend = std::max(std::fabs(curvature_per_m), 1e-6);
  const double curve_speed = std::min(std::sqrt(kLateralAccel_mps2 / bend), config_.limits.max_turn_radps / bend);
  // v^2 = 2 a d with half the comfortable braking: the other half is the jerk's share.
  const double arrival_speed = std::sqrt(config_.limits.max_accel_mps2 * distance(robot, input.goal_in_map));
  const double among_movers =
      choose_speed(input.path, robot, input.permitted_before.v_mps, input.tracks, speed_choice_);
  return std::min({config_.limits.max_speed_mps, curve_speed, arrival_speed, among_movers});
}

}  // namespace jaywalk
