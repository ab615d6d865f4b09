// Turning to the heading wanted at the goal. A wheelchair's foremost corners are 0.817 m from its axle, its rearmost
// ones 0.478 m.
#include "planner/motion/goal_turn.h"

#include <cmath>
#include <utility>

#include "planner/motion/twist_ramp.h"
#include "tests/motion/ground.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::Ground;

namespace {

OperatorInput to_heading(double heading, Vec2 goal = {}) {
  return {.has_goal = true, .goal_in_map = goal, .goal_heading_rad = heading};
}

/// A robot on a map, moved by what the turn wishes, ramped, as a supervisor permits.
struct Bench {
  Bench(const RobotModel& model, const Ground& ground, const OperatorInput& input, const Pose2& start = {})
      : still(ground.map()),
        wanted_input(input),
        pose(start),
        ramp(model.limits),
        turn(model.footprint, model.limits, model.name == "p3dx") {}

  /// A tick of 20 ms; one of `ticks_a_plan` brings a plan.
  void tick() {
    turn.aim(wanted_input, pose, driven);
    ramp.follow(driven);
    const Twist2 target = !turn.active()              ? Twist2{}
                          : turn.manoeuvre().active() ? turn.manoeuvre().command(pose)
                                                      : turn.command(pose);
    const Twist2 wanted = ramp.toward(target, 0.02);
    const bool refused = (wanted.w_radps > 0.0 && refuses_left) || (wanted.w_radps < 0.0 && refuses_right);
    driven = refused ? Twist2{} : wanted;
    const Vec2 ahead = direction(pose.heading) * (driven.v_mps * 0.02);
    pose = {pose.x + ahead.x, pose.y + ahead.y, wrap_angle(pose.heading + driven.w_radps * 0.02)};
    turned += driven.w_radps * 0.02;
    if (ticks++ % ticks_a_plan == 0 && turn.active()) {
      turn.update({.path = path,
                   .map_from_robot = pose,
                   .wanted = wanted,
                   .driven = driven,
                   .still = still,
                   .pedestrian_hidden = hidden,
                   .now = Time{std::chrono::milliseconds(20) * ticks}});
    }
  }
  void run(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds * 50.0); ++k) tick();
  }

  const EvidenceMap& still;
  OperatorInput wanted_input;
  Pose2 pose;
  TwistRamp ramp;
  GoalTurn turn;
  Path path;
  Twist2 driven;
  double turned = 0.0;
  bool hidden = false;  ///< a pedestrian near is out of sight
  bool refuses_left = false, refuses_right = false;
  int ticks = 0;
  int ticks_a_plan = 3;  ///< scans of 16.7 Hz; 10: of 5 Hz
};

/// A pillar of 10 cm about `centre`.
Ground& pillar(Ground& ground, Vec2 centre) { return ground.wall(centre + Vec2{-0.05, 0.0}, centre + Vec2{0.05, 0.0}); }

/// A corridor of 1.2 m along x, closed at x = 1.1 and, where it is `closed`, at x = -0.7; else it opens to the left
/// beyond x = -1.5.
Ground corridor(bool closed) {
  Ground ground;
  ground.wall({1.1, -0.6}, {1.1, 0.6}).wall({-3.9, -0.6}, {1.1, -0.6}).wall({-1.5, 0.6}, {1.1, 0.6});
  if (closed) return ground.wall({-0.7, -0.6}, {-0.7, 0.6});
  return ground.wall({-1.5, 0.6}, {-1.5, 4.0});
}

}  // namespace

TEST_CASE("it takes over within two thirds of the tolerance, and anywhere within it from a robot that stands") {
  // 0.3 m of tolerance: 0.2 m on the move.
  GoalTurn turn(p3dx().footprint, p3dx().limits, true);
  turn.aim(to_heading(1.0, {1.0, 0.0}), {0.79, 0.0, 0.0}, {0.3, 0.0});
  CHECK_FALSE(turn.active());
  turn.aim(to_heading(1.0, {1.0, 0.0}), {0.81, 0.0, 0.0}, {0.3, 0.0});
  CHECK(turn.active());
  const Ground ground;
  turn.update({.path = {}, .map_from_robot = {0.81, 0.0, 0.0}, .wanted = {}, .driven = {}, .still = ground.map()});
  CHECK(turn.command({0.81, 0.0, 0.0}) == Twist2{});  // to rest, before it turns
  turn.aim(to_heading(1.0, {1.0, 0.0}), {0.81, 0.0, 0.0}, {});
  CHECK(turn.command({0.81, 0.0, 0.0}) == Twist2{0.0, 1.5});
  turn.aim(to_heading(1.0, {5.0, 0.0}), {0.81, 0.0, 0.0}, {});
  CHECK_FALSE(turn.active());  // another goal
  turn.aim(to_heading(1.0, {1.1, 0.0}), {0.81, 0.0, 0.0}, {});
  CHECK(turn.active());
  turn.aim(to_heading(1.0, {1.1, 0.0}), {0.79, 0.0, 0.0}, {});
  CHECK_FALSE(turn.active());  // it finds itself outside
}

TEST_CASE("without a heading, without a goal, or with one that is no number it never takes over") {
  GoalTurn turn(p3dx().footprint, p3dx().limits, true);
  OperatorInput none = to_heading(1.0);
  none.has_goal = false;
  for (const OperatorInput& input : {to_heading(kAnyHeading), to_heading(INFINITY), none}) {
    turn.aim(input, {}, {});
    CHECK_FALSE(turn.active());
    CHECK_FALSE(turn.blocked());
  }
}

TEST_CASE("it turns as fast as a gain of 2, the ramp and the robot allow") {
  // 2 rad to go: 2 * 2 = 4, sqrt(3 * 2) = 2.45, at most 1.5 rad/s. 0.3 rad: 2 * 0.3 = 0.6. With a ramp of 0.5 rad/s2:
  // sqrt(0.5 * 0.3) = 0.387.
  const Ground ground;
  const auto rate = [&](double to_go, double ramp_radps2) {
    RobotModel model = p3dx();
    model.limits.max_turn_accel_radps2 = ramp_radps2;
    Bench bench(model, ground, to_heading(to_go));
    bench.turn.aim(bench.wanted_input, {}, {});
    bench.turn.update({.path = {}, .map_from_robot = {}, .wanted = {}, .driven = {}, .still = ground.map()});
    return bench.turn.command({}).w_radps;
  };
  CHECK(rate(2.0, 3.0) == Approx(1.5));
  CHECK(rate(0.3, 3.0) == Approx(0.6));
  CHECK(rate(-0.3, 3.0) == Approx(-0.6));
  CHECK(rate(0.3, 0.5) == Approx(0.3873).epsilon(1e-3));
}

TEST_CASE("it turns the short way to within a third of the tolerance, never past it, and stands") {
  const Ground ground;
  for (const RobotModel& model : {p3dx(), wheelchair()}) {
    for (const double heading : {3.0, -3.0, 0.5, -0.15}) {
      Bench bench(model, ground, to_heading(heading));
      double farthest = 0.0;
      for (int k = 0; k < 400; ++k) {
        bench.tick();
        farthest = std::max(farthest, bench.turned * (heading < 0.0 ? -1.0 : 1.0));
      }
      CHECK(farthest <= std::fabs(heading));
      CHECK(std::fabs(bench.wanted_input.heading_error_rad(bench.pose)) < 0.1 / 3.0 + 1e-9);
      CHECK(bench.driven == Twist2{});
      CHECK(bench.pose.position() == Vec2{});
    }
  }
}

TEST_CASE("once it stands, a pose that sways within the tolerance moves nothing, one beyond does") {
  const Ground ground;
  Bench bench(p3dx(), ground, to_heading(1.0));
  bench.run(4.0);
  REQUIRE(bench.driven == Twist2{});
  CHECK(bench.turn.command({0.0, 0.0, 1.09}) == Twist2{});
  CHECK(bench.turn.command({0.0, 0.0, 0.91}) == Twist2{});
  bench.pose.heading = 0.85;
  bench.run(2.0);
  CHECK(bench.pose.heading == Approx(1.0).margin(0.1 / 3.0));
}

TEST_CASE("a wheelchair with a pillar in its short way turns the long way round, without touching it") {
  // The pillar, 0.65 to 0.75 m to the left: the foremost corner would pass it, the rearmost does not.
  Ground ground;
  pillar(ground, {0.0, 0.7});
  Bench bench(wheelchair(), ground, to_heading(3.0));
  bench.run(12.0);
  CHECK(bench.turned == Approx(3.0 - 2.0 * kPi).margin(0.04));
  CHECK(bench.driven == Twist2{});
  Bench nearly_round(p3dx(), ground, to_heading(3.0));  // 0.297 m about its middle
  nearly_round.run(6.0);
  CHECK(nearly_round.turned == Approx(3.0).margin(0.04));
}

TEST_CASE("a wheelchair that can turn neither way drives a manoeuvre that ends at the goal with its heading") {
  // It has come into a corridor of 1.2 m that it cannot turn in, and is to look out of it: it backs out and in again.
  const Ground ground = corridor(false);
  Bench bench(wheelchair(), ground, to_heading(kPi, {-0.1, 0.0}), {-0.1, 0.0, 0.0});
  double least = 1.0;
  BodyMap map(wheelchair().footprint);
  map.draw(ground.map(), {});
  bool manoeuvred = false;
  for (int k = 0; k < 50 * 60; ++k) {
    bench.tick();
    manoeuvred = manoeuvred || bench.turn.manoeuvre().active();
    least = std::min(least, map.clearance(bench.pose));
  }
  CHECK(manoeuvred);
  CHECK(least > 0.04);
  CHECK(bench.wanted_input.is_reached_at(bench.pose));
  CHECK(bench.driven == Twist2{});
}

TEST_CASE("with somebody near out of sight no manoeuvre begins at once, for it may back") {
  const Ground ground = corridor(false);
  Bench bench(wheelchair(), ground, to_heading(kPi, {-0.1, 0.0}), {-0.1, 0.0, 0.0});
  bench.hidden = true;
  bench.run(4.0);
  CHECK(bench.driven == Twist2{});
  CHECK(bench.pose == Pose2{-0.1, 0.0, 0.0});
  bench.run(3.0);
  CHECK(bench.turn.manoeuvre().active());
}

TEST_CASE("where there is no way at all it waits, and says so") {
  const Ground ground = corridor(true);
  Bench bench(wheelchair(), ground, to_heading(kPi));
  bench.run(4.0);
  CHECK(bench.turn.blocked());
  CHECK(bench.pose == Pose2{});
  bench.wanted_input.goal_heading_rad = 0.05;  // within the tolerance from where it stands
  bench.run(1.0);
  CHECK_FALSE(bench.turn.blocked());
}

TEST_CASE("where there is no way it looks round after ten seconds to the left, after twenty to the right, and waits") {
  Ground ground;
  pillar(ground,
         {-0.6, 0.0});  // behind it, where a laser of 270 degrees does not look: a pedestrian there may have gone
  for (const int ticks_a_plan : {3, 10}) {
    Bench bench(wheelchair(), ground, to_heading(kPi));
    bench.ticks_a_plan = ticks_a_plan;
    bench.run(9.5);
    CHECK(bench.turned == 0.0);
    bench.run(6.5);
    CHECK(bench.turned > 1.5);
    bench.run(15.0);
    CHECK(std::fabs(bench.turned) < 0.3);
    CHECK(bench.turn.blocked());
    const Pose2 before = bench.pose;
    bench.run(30.0);
    CHECK(bench.pose == before);
  }
}

TEST_CASE("a way that was refused for a second is left for the other, and both for ten seconds") {
  const Ground ground;
  Bench bench(p3dx(), ground, to_heading(2.0));
  bench.refuses_left = true;  // a pedestrian stands there
  bench.run(0.9);
  CHECK(bench.turned == 0.0);
  bench.run(8.0);
  CHECK(bench.turned == Approx(2.0 - 2.0 * kPi).margin(0.04));

  Bench held(p3dx(), ground, to_heading(2.0));
  held.refuses_left = held.refuses_right = true;
  held.run(3.0);
  CHECK(held.turn.blocked());
  held.refuses_left = false;
  held.run(5.0);
  CHECK(held.turn.blocked());
  held.run(8.0);
  CHECK(held.turned == Approx(2.0).margin(0.04));
}

TEST_CASE("looking for a way to turn asks nothing of the heap") {
  const Ground ground = corridor(true);
  Bench bench(wheelchair(), ground, to_heading(kPi));
  const AllocationGuard guard;
  bench.run(2.0);
  const auto calls = guard.calls();
  CHECK(bench.turn.blocked());
  CHECK(calls == 0);
}
