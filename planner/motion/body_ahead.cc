#include "planner/motion/body_ahead.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/least_clearance.h"
#include "planner/motion/pursuit.h"

namespace jaywalk {
namespace {

constexpr double kAhead_m = 1.6;  // looked at along the path, whatever the speed
constexpr double kAhead_s = 8.0, kStep_s = 0.1;
constexpr double kTouch_m = 0.05;          // kept of whatever it comes to rest before
constexpr double kBeforeSlowing_s = 0.25;  // the drives' lag, a tick, and the half of it that jerk takes
constexpr double kStopStep_s = 0.05;
constexpr double kRest_mps = 1e-3, kRest_radps = 1e-2;

double toward(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

/// Half a step before, for the middle of an arc.
Pose2 moved(const Pose2& pose, const Twist2& twist, double dt_s) {
  const Vec2 ahead = direction(pose.heading + 0.5 * twist.w_radps * dt_s);
  return {pose.x + ahead.x * twist.v_mps * dt_s, pose.y + ahead.y * twist.v_mps * dt_s,
          wrap_angle(pose.heading + twist.w_radps * dt_s)};
}

/// What the follower would like, not ramped.
Twist2 steered(const Steering& steering, double most_mps, double v_mps, const MotionLimits& limits) {
  if (steering.turns_first()) return {0.0, steering.turn_radps(limits.max_turn_radps)};
  const double v = std::min(most_mps, curve_speed(steering.curvature_per_m, limits.max_turn_radps));
  return {v, steering.circle_radps(std::max(v, v_mps), limits.max_turn_radps)};
}

/// A step later: what drives on its arc, what turns on the spot.
Twist2 slowed(const Twist2& twist, const MotionLimits& limits) {
  const double v = toward(twist.v_mps, 0.0, limits.max_accel_mps2 * kStopStep_s);
  if (v != 0.0) return {v, twist.w_radps / twist.v_mps * v};
  return {0.0, toward(twist.w_radps, 0.0, limits.max_turn_accel_radps2 * kStopStep_s)};
}

}  // namespace

bool at_rest(const Twist2& twist) noexcept {
  return std::fabs(twist.v_mps) < kRest_mps && std::fabs(twist.w_radps) < kRest_radps;
}

bool BodyAhead::follows(const Path& path, double most_mps, double margin_m) const noexcept {
  Pose2 pose = map_from_robot;
  Twist2 twist{std::max(driven.v_mps, 0.0), driven.w_radps};
  const double at_start = map.clearance(pose);
  double room = at_start, gone = 0.0;
  for (double t = 0.0; t < kAhead_s && gone < kAhead_m; t += kStep_s) {
    const Steering steering = pursue(path, pose, twist.v_mps);
    const Twist2 wanted = steered(steering, most_mps, twist.v_mps, limits);
    twist.v_mps = toward(twist.v_mps, wanted.v_mps, limits.max_accel_mps2 * kStep_s);
    twist.w_radps = toward(twist.w_radps, wanted.w_radps, limits.max_turn_accel_radps2 * kStep_s);
    pose = moved(pose, twist, kStep_s);
    gone += twist.v_mps * kStep_s;
    const double least = least_clearance_m(margin_m, at_start, room);
    room = map.clearance(pose);
    if (room < least) return false;
    const BodyMap::Part swings = steering.turns_first() ? BodyMap::Part::kAll : BodyMap::Part::kBehindAxle;
    if (map.goes_unseen(pose.position(), direction(pose.heading), swings)) return false;
    if (distance(pose.position(), path.back()) < margin_m) return true;
  }
  return true;
}

bool BodyAhead::stops_in_time() const noexcept {
  const double at_start = map.clearance(map_from_robot);
  Pose2 pose = map_from_robot;
  Twist2 twist = driven;
  double room = at_start;
  for (double t = 0.0; !at_rest(twist); t += kStopStep_s) {
    if (t >= kBeforeSlowing_s) twist = slowed(twist, limits);
    pose = moved(pose, twist, kStopStep_s);
    const double least = least_clearance_m(kTouch_m, at_start, room);
    room = map.clearance(pose);
    if (room < least) return false;
  }
  return true;
}

}  // namespace jaywalk
