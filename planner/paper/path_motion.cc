#include "planner/paper/path_motion.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::paper {
namespace {

constexpr double kLookAhead_m = 0.35;          // at rest; half a robot's length
constexpr double kLookAhead_s = 0.7;           // plus so much travel
constexpr double kTurnInPlaceAbove_rad = 1.0;  // looking further away than this, turn before driving
constexpr double kTurnGain_per_s = 2.0;        // turn in place at this rate a radian of error

}  // namespace

std::size_t nearest_point(const Path& path, Vec2 place) noexcept {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (distance(path[i], place) < distance(path[nearest], place)) nearest = i;
  }
  return nearest;
}

Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept {
  for (std::size_t i = nearest_point(path, robot); i + 1 < path.size(); ++i) {
    const double piece = distance(path[i], path[i + 1]);
    if (piece > ahead_m) return path[i] + (path[i + 1] - path[i]) * (ahead_m / piece);
    ahead_m -= piece;
  }
  return path.back();
}

bool Steering::turns_first() const noexcept { return std::fabs(bearing) > kTurnInPlaceAbove_rad; }

double Steering::turn_radps(double most_radps) const noexcept {
  return std::clamp(kTurnGain_per_s * bearing, -most_radps, most_radps);
}

double Steering::circle_radps(double v_mps, double most_radps) const noexcept {
  return std::clamp(curvature_per_m * v_mps, -most_radps, most_radps);
}

Steering pursue(const Path& path, const Pose2& map_from_robot, double v_mps) noexcept {
  const Vec2 target =
      inverse(map_from_robot) * look_ahead(path, map_from_robot.position(), kLookAhead_m + kLookAhead_s * v_mps);
  // The circle through here and the target that is tangent to the heading has curvature 2 y / d^2.
  return {atan2(target.y, target.x), 2.0 * target.y / std::max(dot(target, target), 1e-6)};
}

PathMotion::PathMotion(const motion::MotionSetup& setup)
    : limits_(setup.model.limits), tick_s_(setup.tick_s), ramp_(setup.model.limits) {}

void PathMotion::observe(const motion::World& world, const motion::Intent&) noexcept {
  status_.rests_on = world.plan.status == PlanStatus::kOk ? world.plan.stamp : kNever;  // else it would go straight on
}

Twist2 PathMotion::command(const motion::World& world, const motion::Intent& intent) noexcept {
  ramp_.follow(world.driven);
  return ramp_.toward(target(world, intent), tick_s_);
}

Twist2 PathMotion::target(const motion::World& world, const motion::Intent& intent) const noexcept {
  if (intent.kind != motion::Intent::Kind::kGoal) return {};
  const double cruise = limits_.max_speed_mps;
  if (world.plan.path.empty()) return {cruise, 0.0};
  const double v_now = std::max(world.driven.v_mps, 0.0);
  const Steering steering = pursue(world.plan.path, world.map_from_robot, v_now);
  if (steering.turns_first()) return {cruise, steering.turn_radps(limits_.max_turn_radps)};
  return {cruise, steering.circle_radps(std::max(cruise, v_now), limits_.max_turn_radps)};
}

PlanRequest PathMotion::request(const motion::World& world) const noexcept {
  return {.stamp = world.scan.stamp,
          .map_from_robot = world.map_from_robot,
          .goal_in_map = world.input.goal_in_map,
          .speed_mps = limits_.max_speed_mps,
          .still = &world.perceived.still,
          .moving = world.perceived.moving,
          .standing = world.perceived.standing};
}

}  // namespace jaywalk::paper
