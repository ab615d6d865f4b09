// Somebody stops right before a wheelchair that drives: it brakes as hard as its drives do, and no harder than it must.
#include <array>

#include "planner/motion/follower.h"
#include "planner/motion/footprint_guide.h"
#include "tests/motion/ground.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::Ground;

namespace {

constexpr double kTick_s = 0.02, kPersonM = 0.25;
const RobotModel kChair = wheelchair();

Path straight_path() {
  Path path;
  for (int k = 0; k <= 50; ++k) (void)path.push_back({0.1 * k, 0.0});
  return path;
}

/// Somebody who has stopped `gap_m` before the front of a wheelchair at (0, 0).
Track stopped(double gap_m) {
  Track track;
  track.moving = true;
  track.radius_m = kPersonM;
  track.position_in_map = {kChair.footprint.front_m + gap_m + kPersonM, 0.0};
  return track;
}

/// The way (m) it goes until it stands, from 0.5 m/s, and the most that it slows down within a tick (m/s).
struct Stop {
  double way_m = 0.0, hardest_mps = 0.0;
};
Stop stop_before(double gap_m) {
  const Ground ground;
  const Path path = straight_path();
  const std::array walker{stopped(gap_m)};
  FootprintGuide guide(kChair.footprint, kChair.limits);
  Follower follower({.limits = kChair.limits, .robot = {.footprint = kChair.footprint}, .stands_at_worst = true});
  Twist2 driven{0.5, 0.0};
  Stop stop;
  for (int tick = 0; tick < 200 && driven.v_mps > 0.0; ++tick) {
    const Pose2 here{stop.way_m, 0.0, 0.0};
    if (tick % 3 == 0)
      guide.look({.path = path,
                  .map_from_robot = here,
                  .wanted = driven,
                  .driven = driven,
                  .still = ground.map(),
                  .moving = walker});
    const Twist2 before = driven;
    driven = follower.twist({.path = path,
                             .map_from_robot = here,
                             .goal_in_map = {5.0, 0.0},
                             .has_goal = true,
                             .tracks = walker,
                             .permitted_before = driven,
                             .guide = &guide});
    stop.hardest_mps = std::max(stop.hardest_mps, before.v_mps - driven.v_mps);
    stop.way_m += driven.v_mps * kTick_s;
  }
  return stop;
}

}  // namespace

TEST_CASE("before somebody who stops at its feet a wheelchair brakes hard, and stands in time") {
  const Stop stop = stop_before(0.22);  // 0.5 m/s: 0.125 m at 1 m/s2, 0.25 m and more within comfort
  CHECK(stop.way_m < 0.20);
  CHECK(stop.hardest_mps == Approx(kChair.limits.brake_mps2 * kTick_s));
}

TEST_CASE("before somebody who stops farther off it slows down within comfort") {
  const Stop stop = stop_before(0.9);
  CHECK(stop.way_m < 0.9);
  CHECK(stop.hardest_mps <= kChair.limits.max_accel_mps2 * kTick_s + 1e-9);
}

TEST_CASE("turning on the spot towards somebody who stops there it brakes hard as well") {
  const Ground ground;
  Path path;
  for (int k = 0; k <= 50; ++k) (void)path.push_back({0.0, -0.1 * k});
  Track walker = stopped(0.0);
  walker.position_in_map = {0.75, -0.68};  // 0.1 m from its right front corner
  const std::array tracks{walker};
  FootprintGuide guide(kChair.footprint, kChair.limits);
  guide.look({.path = path, .wanted = {}, .driven = {0.0, -1.0}, .still = ground.map(), .moving = tracks});
  CHECK(guide.most_speed_mps() == 0.0);
  CHECK(guide.brakes_hard());
  Follower follower({.limits = kChair.limits, .robot = {.footprint = kChair.footprint}, .stands_at_worst = true});
  const Twist2 next = follower.twist({.path = path,
                                      .map_from_robot = {},
                                      .goal_in_map = {0.0, -5.0},
                                      .has_goal = true,
                                      .tracks = tracks,
                                      .permitted_before = {0.0, -1.0},
                                      .guide = &guide});
  CHECK(next.v_mps == 0.0);
  CHECK(next.w_radps == Approx(-1.0 + 0.02 / 0.325));  // 1 m/s2 at its sides
}

TEST_CASE("a turn at the goal that takes over from a guide which braked hard is not held up by it") {
  const Ground ground;
  const Path path = straight_path();
  const std::array walker{stopped(0.22)};
  FootprintGuide guide(kChair.footprint, kChair.limits);
  guide.look({.path = path, .wanted = {0.5, 0.0}, .driven = {0.5, 0.0}, .still = ground.map(), .moving = walker});
  REQUIRE(guide.brakes_hard());
  GoalTurn turn(kChair.footprint, kChair.limits, false);
  const OperatorInput input{.has_goal = true, .goal_in_map = {}, .goal_heading_rad = 1.0};
  turn.aim(input, {}, {});
  REQUIRE(turn.active());
  turn.look({.path = path, .still = ground.map()});
  Follower follower({.limits = kChair.limits, .robot = {.footprint = kChair.footprint}});
  const Twist2 next = follower.twist({.path = path,
                                      .map_from_robot = {},
                                      .goal_in_map = {},
                                      .has_goal = true,
                                      .tracks = {},
                                      .permitted_before = {},
                                      .guide = &guide,
                                      .turn = &turn});
  CHECK(next.w_radps > 0.0);
}
