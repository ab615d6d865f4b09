// Scripted sticks: where a hand stands at a time, and what it makes of where the robot is.
#include "hal/sim/sensors.h"
#include "hal/sim/simulation.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

Truth at(double t_s, const Pose2& pose = {}) {
  Truth truth;
  truth.now = time_from_seconds(t_s);
  truth.map_from_robot = pose;
  return truth;
}

Scenario with_goal(Vec2 goal) {
  Scenario scenario;
  scenario.goal = goal;
  return scenario;
}

}  // namespace

TEST_CASE("a stick that is held straight is in its middle until the hand has come, and full ahead from then on") {
  ScriptedStick stick({.kind = StickKind::kStraight, .forward = 0.8, .delay_s = 0.1}, with_goal({5.0, 0.0}), 1);
  CHECK(stick.at(at(0.0)).is_centred());
  CHECK(stick.at(at(0.05)).is_centred());
  CHECK(stick.at(at(0.1)).forward == 0.8);
  CHECK(stick.at(at(9.0)).left == 0.0);
}

TEST_CASE("a stick that is pointed at the goal turns first, goes ahead, and is let go within half the tolerance") {
  ScriptedStick stick({.kind = StickKind::kToGoal, .delay_s = 0.0}, with_goal({4.0, 0.0}), 1);
  CHECK(stick.at(at(0.0, {0.0, 0.0, 0.0})).forward == 1.0);
  const Stick aside = stick.at(at(0.1, {0.0, 0.0, -0.5}));  // the goal lies 0.5 rad to the left
  CHECK(aside.left == Approx(0.6));
  CHECK(aside.forward == 1.0);
  const Stick behind = stick.at(at(0.2, {0.0, 0.0, 3.0}));
  CHECK(behind.forward == 0.0);
  CHECK(behind.left == -1.0);
  CHECK(stick.at(at(0.3, {3.9, 0.0, 0.0})).is_centred());
}

TEST_CASE("a table's rows hold until the next, and a hand comes late by its delay") {
  const auto file = folder().write("stick.csv", "t_s,forward,left\n1,0.5,0\n2,0,-1\n3,0,0\n");
  ScriptedStick stick({.kind = StickKind::kTable, .delay_s = 0.2, .file = file}, with_goal({}), 1);
  for (double t = 0.0; t < 4.0; t += 0.02) {
    const Stick now = stick.at(at(t));
    if (t > 0.1 && t < 1.19) REQUIRE(now.is_centred());
    if (t > 1.22 && t < 2.18) REQUIRE(now.forward == 0.5);
    if (t > 2.22 && t < 3.18) REQUIRE(now.left == -1.0);
    if (t > 3.22) REQUIRE(now.is_centred());
  }
}

TEST_CASE("a table that is none is refused with its line") {
  check_refused(
      {{"t,f,l\n", "stick.csv:1: does not begin with t_s,forward,left"},
       {"t_s,forward,left\n0,1,0\n0,1,0\n", "stick.csv:3: "},
       {"t_s,forward,left\n0,1.5,0\n", "stick.csv:2: "},
       {"t_s,forward,left\n0,1\n", "stick.csv:2: "},
       {"t_s,forward,left\n", "holds no row"}},
      [](const std::string& text) {
        const auto file = folder().write("stick.csv", text);
        return refusal_of([&] { ScriptedStick({.kind = StickKind::kTable, .file = file}, with_goal({}), 1); });
      });
}

TEST_CASE("a hand trembles as much as it is said to, the same with the same seed, and not while it rests") {
  const StickSpec trembling{.kind = StickKind::kStraight, .forward = 0.5, .noise_std = 0.1, .delay_s = 0.0};
  ScriptedStick one(trembling, with_goal({}), 3), same(trembling, with_goal({}), 3);
  double sum2 = 0.0;
  constexpr int kTicks = 50000;
  for (int k = 0; k < kTicks; ++k) {
    const Stick stick = one.at(at(0.02 * k)), again = same.at(at(0.02 * k));
    REQUIRE(stick.left == again.left);
    sum2 += stick.left * stick.left;
  }
  CHECK(std::sqrt(sum2 / kTicks) == Approx(0.1).epsilon(0.1));  // 2000 independent halves of a second: 2 %
}
