#include "planner/motion/turning_motion.h"

namespace jaywalk::motion {

TurningMotion::TurningMotion(const MotionSetup& setup, std::unique_ptr<Motion> to_goal)
    : setup_(setup),
      to_goal_(std::move(to_goal)),
      turn_(setup.model.footprint, setup.model.limits, true),
      follower_({.limits = setup.model.limits,
                 .robot = {.radius_m = setup.mover_radius_m},
                 .goal_tolerance_m = setup.goal_tolerance_m,
                 .tick_s = setup.tick_s}) {}

void TurningMotion::observe(const World& world, const Intent& intent) noexcept {
  to_goal_->observe(world, intent);
  rests_on_ = turn_.active() ? stamp_of_path(world) : to_goal_->status().rests_on;
  turn_.aim(world.input, world.map_from_robot, world.driven);
}

Twist2 TurningMotion::command(const World& world, const Intent& intent) noexcept {
  if (!turn_.active()) return to_goal_->command(world, intent);
  return follower_.turning(turn_, follower_input(world, intent));
}

void TurningMotion::decide(const World& world, const Intent& intent) noexcept {
  if (world.new_plan && turn_.active()) turn_.update(guide_input(world, setup_.keep_out_zones()));
  to_goal_->decide(world, intent);
}

MotionStatus TurningMotion::status() const noexcept {
  return {.rests_on = rests_on_, .turns_at_goal = turn_.active(), .turn_blocked = turn_.blocked()};
}

}  // namespace jaywalk::motion
