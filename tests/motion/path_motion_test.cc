#include "planner/paper/paper.h"
#include "tests/motion/moment.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

Path line(Vec2 from, Vec2 to) {
  Path path;
  for (int k = 0; k <= 50; ++k) REQUIRE(path.push_back(from + (to - from) * (k / 50.0)));
  return path;
}

/// Twist after so many ticks along a path from standstill, the robot held where it is.
Twist2 settled(const Path& path, bool has_goal = true) {
  tests::Moment moment;
  moment.plan.path = path;
  if (has_goal) moment.go_to({5.0, 0.0});
  RobotModel model = p3dx();
  model.limits.max_speed_mps = 0.6, model.limits.max_turn_radps = 1.5;
  const auto motion = paper::make_motion({.model = model, .constant_speed = true});
  for (int k = 0; k < 200; ++k) {
    moment.drive(*motion, 0.02);
    moment.pose = {};
  }
  return moment.driven;
}

}  // namespace

TEST_CASE("on a straight path the robot drives straight at full speed, and turns to one beside it") {
  CHECK(settled(line({0, 0}, {5, 0})).v_mps == Approx(0.6));
  CHECK(settled(line({0, 0}, {5, 0})).w_radps == Approx(0.0).margin(1e-9));
  CHECK(settled(line({0, 0.3}, {5, 0.3})).w_radps > 0.05);
}

TEST_CASE("at constant speed it never stops, not even to turn round, at a path's end or without a path") {
  const Twist2 behind = settled(line({0, 0}, {-5, 0.1}));
  CHECK(behind.v_mps == Approx(0.6));
  CHECK(behind.w_radps == Approx(1.5));
  CHECK(settled(line({0, 0}, {0.05, 0})).v_mps == Approx(0.6));
  CHECK(settled(Path{}).v_mps == Approx(0.6));
  CHECK(settled(Path{}, false).v_mps == 0.0);
}

TEST_CASE("looking ahead begins at the nearest of a path's points, of two as near at the first") {
  const Path path = line({0, 0}, {5, 0});  // 0.1 m apart
  CHECK(paper::look_ahead(path, {2.04, 0.7}, 0.0) == path[20]);
  CHECK(paper::look_ahead(path, {9.0, 0.0}, 0.0) == path[50]);
  Path two;
  REQUIRE((two.push_back({0.0, 1.0}) && two.push_back({0.0, -1.0})));
  CHECK(paper::look_ahead(two, {0.0, 0.0}, 0.0) == two[0]);
}

TEST_CASE("looking ahead 0.5 m from beside the middle of a line finds the point 0.5 m on") {
  const Vec2 p = paper::look_ahead(line({0, 0}, {5, 0}), {2.0, 0.4}, 0.5);
  CHECK(p.x == Approx(2.5));
  CHECK(p.y == Approx(0.0));
  CHECK(paper::look_ahead(line({0, 0}, {5, 0}), {4.9, 0.0}, 3.0).x == Approx(5.0));
}
