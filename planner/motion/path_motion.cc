#include "planner/motion/path_motion.h"

namespace jaywalk::motion {

PathMotion::PathMotion(const MotionSetup& setup)
    : speed_mps_(setup.model.limits.max_speed_mps),
      follower_({.limits = setup.model.limits,
                 .robot = {.radius_m = setup.mover_radius_m},
                 .constant_speed = true,
                 .goal_tolerance_m = setup.goal_tolerance_m,
                 .tick_s = setup.tick_s}) {}

void PathMotion::observe(const World& world, const Intent&) noexcept {
  status_.rests_on = world.plan.status == PlanStatus::kOk ? world.plan.stamp : kNever;  // else it would go straight on
}

Twist2 PathMotion::command(const World& world, const Intent& intent) noexcept {
  return follower_.along_path(follower_input(world, intent));
}

PlanRequest PathMotion::request(const World& world) const noexcept {
  return {.stamp = world.scan.stamp,
          .map_from_robot = world.map_from_robot,
          .goal_in_map = world.input.goal_in_map,
          .speed_mps = speed_mps_,
          .still = &world.perceived.still,
          .moving = world.perceived.moving,
          .standing = world.perceived.standing};
}

}  // namespace jaywalk::motion
