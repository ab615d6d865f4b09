#include "planner/motion/path_motion.h"

#include <algorithm>

#include "planner/motion/pursuit.h"

namespace jaywalk::motion {

PathMotion::PathMotion(const MotionSetup& setup)
    : limits_(setup.model.limits), tick_s_(setup.tick_s), ramp_(setup.model.limits) {}

void PathMotion::observe(const World& world, const Intent&) noexcept {
  status_.rests_on = world.plan.status == PlanStatus::kOk ? world.plan.stamp : kNever;  // else it would go straight on
}

Twist2 PathMotion::command(const World& world, const Intent& intent) noexcept {
  ramp_.follow(world.driven);
  return ramp_.toward(target(world, intent), tick_s_);
}

Twist2 PathMotion::target(const World& world, const Intent& intent) const noexcept {
  if (intent.kind != Intent::Kind::kGoal) return {};
  const double cruise = limits_.max_speed_mps;
  if (world.plan.path.empty()) return {cruise, 0.0};
  const double v_now = std::max(world.driven.v_mps, 0.0);
  const Steering steering = pursue(world.plan.path, world.map_from_robot, v_now);
  if (steering.turns_first()) return {cruise, steering.turn_radps(limits_.max_turn_radps)};
  return {cruise, steering.circle_radps(std::max(cruise, v_now), limits_.max_turn_radps)};
}

PlanRequest PathMotion::request(const World& world) const noexcept {
  return {.stamp = world.scan.stamp,
          .map_from_robot = world.map_from_robot,
          .goal_in_map = world.input.goal_in_map,
          .speed_mps = limits_.max_speed_mps,
          .still = &world.perceived.still,
          .moving = world.perceived.moving,
          .standing = world.perceived.standing};
}

}  // namespace jaywalk::motion
