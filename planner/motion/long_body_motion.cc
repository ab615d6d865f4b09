#include "planner/motion/long_body_motion.h"

namespace jaywalk::motion {

LongBodyMotion::LongBodyMotion(const MotionSetup& setup)
    : setup_(setup),
      guide_(setup.model.footprint, setup.model.limits),
      turn_(setup.model.footprint, setup.model.limits, false),
      follower_({.limits = setup.model.limits,
                 .robot = {.footprint = setup.model.footprint},
                 .stands_at_worst = true,
                 .goal_tolerance_m = setup.goal_tolerance_m,
                 .tick_s = setup.tick_s}) {}

void LongBodyMotion::observe(const World& world, const Intent&) noexcept {
  rests_on_ = stamp_of_path(world);
  turn_.aim(world.input, world.map_from_robot, world.driven);
}

Twist2 LongBodyMotion::command(const World& world, const Intent& intent) noexcept {
  const FollowerInput input = follower_input(world, intent);
  if (turn_.active()) return follower_.turning(turn_, input);
  if (guide_.brakes_hard()) return follower_.braking_hard(input);
  if (!follower_.is_under_way(input)) return follower_.to_rest(input);
  if (guide_.manoeuvre().active()) return follower_.along(guide_.manoeuvre(), input);
  if (guide_.most_speed_mps() == 0.0) return follower_.to_rest(input);
  return follower_.along_path(input, guide_.most_speed_mps());
}

void LongBodyMotion::decide(const World& world, const Intent&) noexcept {
  if (!world.new_plan) return;
  const GuideInput input = guide_input(world, setup_.keep_out_zones());
  if (!turn_.active()) return guide_.update(input);
  turn_.update(input);
  guide_.manoeuvre().stop();
}

MotionStatus LongBodyMotion::status() const noexcept {
  return {.rests_on = rests_on_, .turns_at_goal = turn_.active(), .turn_blocked = turn_.blocked()};
}

PlanRequest LongBodyMotion::request(const World& world) const noexcept {
  return {.stamp = world.scan.stamp,
          .map_from_robot = world.map_from_robot,
          .goal_in_map = world.input.goal_in_map,
          .speed_mps = setup_.model.limits.max_speed_mps,
          .still = &world.perceived.still,
          .moving = world.perceived.moving,
          .standing = world.perceived.standing,
          .body = &setup_.model.footprint};
}

}  // namespace jaywalk::motion
