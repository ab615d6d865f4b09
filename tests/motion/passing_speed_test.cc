// Past standing pedestrians: slowly, and the slower the nearer.
#include "planner/motion/passing_speed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/motion/follower.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kRobotM = 0.3, kPersonM = 0.25, kTop_mps = 0.6, kAccel_mps2 = 0.5;
const SpeedChoiceConfig kConfig{
    .robot = {.radius_m = kRobotM}, .max_speed_mps = kTop_mps, .max_accel_mps2 = kAccel_mps2};

/// Straight ahead along +x from the origin, 10 m in steps of 0.1 m.
Path straight_path() {
  Path path;
  for (int k = 0; k <= 100; ++k) REQUIRE(path.push_back({0.1 * k, 0.0}));
  return path;
}

/// The most at `x` on the path, past a pedestrian beside (3, 0) that leaves this gap there.
double past(double x, double gap_m) {
  const std::array standing{StandingPedestrian{{3.0, kRobotM + kPersonM + gap_m}, kPersonM}};
  return passing_speed({straight_path()}, {x, 0.0, 0}, standing, {}, kConfig);
}

}  // namespace

TEST_CASE("nobody, or somebody far aside, slows nothing") {
  CHECK(passing_speed({straight_path()}, {0, 0, 0}, {}, {}, kConfig) == kTop_mps);
  CHECK(past(3.0, 0.7) == kTop_mps);
  const std::array standing{StandingPedestrian{{0.0, 0.0}, kPersonM}};
  CHECK(passing_speed({Path{}}, {}, standing, {}, kConfig) == kTop_mps);
}

TEST_CASE("a long body minds whom its front passes, and not only whom its axle does") {
  SpeedChoiceConfig chair = kConfig;
  chair.robot = {.footprint = {.front_m = 0.75, .rear_m = 0.35, .half_width_m = 0.325}};
  const std::array standing{StandingPedestrian{{0.9, -0.72}, kPersonM}};  // 0.42 m from its corner
  CHECK(passing_speed({straight_path()}, {}, standing, {}, chair) == Approx(0.2));
  const std::array abeam{StandingPedestrian{{0.2, -1.0}, kPersonM}};
  CHECK(passing_speed({straight_path()}, {}, abeam, {}, chair) == Approx(1.0 - 0.325 - 0.25));
}

TEST_CASE("beside somebody the gap takes a second, and the robot creeps on where there is none") {
  CHECK(past(3.0, 0.4) == Approx(0.4));
  CHECK(past(3.0, 0.25) == Approx(0.25));
  CHECK(past(3.0, 0.05) == Approx(0.2));
  CHECK(past(3.0, -0.1) == Approx(0.2));
  const std::array nearer{StandingPedestrian{{3.0, 1.0}, kPersonM}};  // than from the path: 0.35 m, not 0.45
  CHECK(passing_speed({straight_path()}, {3.0, 0.1, 0}, nearer, {}, kConfig) == Approx(0.35));
  SpeedChoiceConfig slow = kConfig;
  slow.max_speed_mps = 0.1;
  const std::array standing{StandingPedestrian{{3.0, 0.5}, kPersonM}};
  CHECK(passing_speed({straight_path()}, {3.0, 0.0, 0}, standing, {}, slow) == 0.1);
}

TEST_CASE("it slows in time, with half the comfortable braking, beside the path or on it") {
  const double gap_m = GENERATE(0.1, -0.55);
  CHECK(past(0.0, gap_m) == kTop_mps);
  constexpr double kStep_s = 0.02;
  double v = kTop_mps, hardest_mps2 = 0.0;
  for (double x = 0.0; x < 3.0; x += v * kStep_s) {
    const double before = v;
    v = std::min(v, past(x, gap_m));
    hardest_mps2 = std::max(hardest_mps2, (before - v) / kStep_s);
  }
  CHECK(v == Approx(0.2).margin(0.01));
  CHECK(hardest_mps2 < 1.2 * 0.5 * kAccel_mps2);
}

TEST_CASE("who walks and has stopped for now counts as well, and who goes on does not") {
  Track walker;
  walker.position_in_map = {3.0, 0.75};
  walker.radius_m = kPersonM;
  walker.moving = true;
  CHECK(passing_speed({straight_path()}, {3.0, 0.0, 0}, {}, std::array{walker}, kConfig) == Approx(0.2));
  walker.velocity_in_map = {0.0, 0.4};
  CHECK(passing_speed({straight_path()}, {3.0, 0.0, 0}, {}, std::array{walker}, kConfig) == kTop_mps);
  walker.velocity_in_map = {};
  walker.moving = false;  // a pillar: known pedestrians are in the other list
  CHECK(passing_speed({straight_path()}, {3.0, 0.0, 0}, {}, std::array{walker}, kConfig) == kTop_mps);
}

TEST_CASE("the follower goes by at that speed") {
  const MotionLimits limits{.max_speed_mps = kTop_mps,
                            .max_turn_radps = 1.5,
                            .max_accel_mps2 = kAccel_mps2,
                            .max_turn_accel_radps2 = 3.0,
                            .max_jerk_mps3 = 2.0,
                            .brake_mps2 = 1.0};
  Follower follower({.limits = limits, .robot = {.radius_m = kRobotM}});
  const Path path = straight_path();
  const std::array standing{StandingPedestrian{{3.0, 0.8}, kPersonM}};
  Twist2 twist;
  for (int k = 0; k < 200; ++k) {
    twist = follower.along_path({.path = path,
                                 .map_from_robot = {3.0, 0.0, 0.0},
                                 .goal_in_map = {10.0, 0.0},
                                 .has_goal = true,
                                 .tracks = {},
                                 .standing = standing,
                                 .permitted_before = twist});
  }
  CHECK(twist.v_mps == Approx(0.25).margin(0.005));
}
