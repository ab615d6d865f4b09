#include "planner/motion/follower.h"

#include "planner/motion/pursuit.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

const MotionLimits kLimits{.max_speed_mps = 0.6,
                           .max_turn_radps = 1.5,
                           .max_accel_mps2 = 0.5,
                           .max_turn_accel_radps2 = 3.0,
                           .max_jerk_mps3 = 2.0,
                           .brake_mps2 = 1.0};

Path line(Vec2 from, Vec2 to) {
  Path path;
  for (int k = 0; k <= 50; ++k) REQUIRE(path.push_back(from + (to - from) * (k / 50.0)));
  return path;
}

/// Twist after `ticks` of following from standstill, the robot held where it is.
Twist2 settled(FollowerConfig config, const Path& path, const Pose2& pose, Vec2 goal, int ticks = 200) {
  Follower follower(config);
  Twist2 twist;
  for (int k = 0; k < ticks; ++k) {
    twist = follower.along_path({.path = path,
                                 .map_from_robot = pose,
                                 .goal_in_map = goal,
                                 .has_goal = true,
                                 .tracks = {},
                                 .permitted_before = twist});
  }
  return twist;
}

}  // namespace

TEST_CASE("on a straight path the robot drives straight at full speed") {
  const Twist2 twist = settled({.limits = kLimits}, line({0, 0}, {5, 0}), {0, 0, 0}, {5, 0});
  CHECK(twist.v_mps == Approx(0.6));
  CHECK(twist.w_radps == Approx(0.0).margin(1e-9));
}

TEST_CASE("a path to the left is turned to, one behind is turned to on the spot") {
  CHECK(settled({.limits = kLimits}, line({0, 0.3}, {5, 0.3}), {0, 0, 0}, {5, 0.3}).w_radps > 0.05);
  const Twist2 behind = settled({.limits = kLimits}, line({0, 0}, {-5, 0.1}), {0, 0, 0}, {-5, 0.1});
  CHECK(behind.v_mps == Approx(0.0).margin(1e-9));
  CHECK(behind.w_radps == Approx(1.5));
}

TEST_CASE("at constant speed it never stops, not even to turn round or at the goal") {
  const FollowerConfig config{.limits = kLimits, .constant_speed = true};
  CHECK(settled(config, line({0, 0}, {-5, 0.1}), {0, 0, 0}, {-5, 0.1}).v_mps == Approx(0.6));
  CHECK(settled(config, line({0, 0}, {0.05, 0}), {0, 0, 0}, {0.05, 0}).v_mps == Approx(0.6));
}

TEST_CASE("near the goal it slows and within a third of the tolerance it stands") {
  // v = sqrt(a d): 0.2 m before the goal sqrt(0.5 * 0.2) = 0.316 m/s.
  CHECK(settled({.limits = kLimits}, line({0, 0}, {0.2, 0}), {0, 0, 0}, {0.2, 0}).v_mps ==
        Approx(0.3162).epsilon(0.01));
  CHECK(settled({.limits = kLimits}, line({0, 0}, {0.09, 0}), {0, 0, 0}, {0.09, 0}).v_mps == 0.0);
}

TEST_CASE("without a path it comes to rest") {
  CHECK(settled({.limits = kLimits}, Path{}, {0, 0, 0}, {5, 0}).v_mps == 0.0);
}

TEST_CASE("of a path's points the nearest is told, of two as near the first") {
  const Path path = line({0, 0}, {5, 0});  // 0.1 m apart
  CHECK(nearest_point(path, {2.04, 0.7}) == 20);
  CHECK(nearest_point(path, {9.0, 0.0}) == 50);
  Path two;
  REQUIRE((two.push_back({0.0, 1.0}) && two.push_back({0.0, -1.0})));
  CHECK(nearest_point(two, {0.0, 0.0}) == 0);
}

TEST_CASE("looking ahead 0.5 m from beside the middle of a line finds the point 0.5 m on") {
  const Vec2 p = look_ahead(line({0, 0}, {5, 0}), {2.0, 0.4}, 0.5);
  CHECK(p.x == Approx(2.5));
  CHECK(p.y == Approx(0.0));
  CHECK(look_ahead(line({0, 0}, {5, 0}), {4.9, 0.0}, 3.0).x == Approx(5.0));
}
