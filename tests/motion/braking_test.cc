// A pedestrian stops right before a wheelchair that drives: it brakes as hard as its drives do, and no harder than it
// must.
#include <array>

#include "planner/motion/footprint_guide.h"
#include "planner/motion/long_body_motion.h"
#include "tests/motion/ground.h"
#include "tests/motion/moment.h"
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

/// A pedestrian that has stopped `gap_m` before the front of a wheelchair at (0, 0).
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
  tests::Moment moment(ground.map());
  moment.go_to({5.0, 0.0});
  moment.plan.status = PlanStatus::kOk;
  moment.plan.path = straight_path();
  moment.tracks = {stopped(gap_m)};
  moment.driven = moment.wanted = {0.5, 0.0};
  motion::LongBodyMotion motion({.model = kChair, .tick_s = kTick_s});
  Stop stop;
  for (int tick = 0; tick < 200 && moment.driven.v_mps > 0.0; ++tick) {
    if (tick % 3 == 0) moment.decide(motion);
    const Twist2 before = moment.driven;
    moment.drive(motion, kTick_s);
    stop.hardest_mps = std::max(stop.hardest_mps, before.v_mps - moment.driven.v_mps);
  }
  stop.way_m = moment.pose.x;
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
  guide.update({.path = path, .wanted = {}, .driven = {0.0, -1.0}, .still = ground.map(), .moving = tracks});
  CHECK(guide.most_speed_mps() == 0.0);
  CHECK(guide.brakes_hard());
  tests::Moment moment(ground.map());
  moment.go_to({0.0, -5.0});
  moment.plan.path = path;
  moment.tracks = {walker};
  moment.driven = {0.0, -1.0};
  motion::LongBodyMotion motion({.model = kChair, .tick_s = kTick_s});
  moment.decide(motion);
  moment.drive(motion, 0.0);
  CHECK(moment.driven.v_mps == 0.0);
  CHECK(moment.driven.w_radps == Approx(-1.0 + 0.02 / 0.325));  // 1 m/s2 at its sides
}

TEST_CASE("a turn at the goal that takes over from a guide which braked hard is not held up by it") {
  const Ground ground;
  tests::Moment moment(ground.map());
  moment.go_to({5.0, 0.0});
  moment.plan.path = straight_path();
  moment.tracks = {stopped(0.22)};
  moment.driven = moment.wanted = {0.5, 0.0};
  motion::LongBodyMotion motion({.model = kChair, .tick_s = kTick_s});
  moment.decide(motion);
  moment.drive(motion, 0.0);
  REQUIRE(moment.driven.v_mps == Approx(0.5 - kChair.limits.brake_mps2 * kTick_s));  // it brakes hard
  moment.go_to({});
  moment.input.goal_heading_rad = 1.0;
  moment.tracks.clear();
  moment.driven = moment.wanted = {};
  moment.drive(motion, 0.0);
  REQUIRE(motion.status().turns_at_goal);
  moment.decide(motion);
  moment.drive(motion, 0.0);
  CHECK(moment.driven.w_radps > 0.0);
}
