// What a reset waits for.
#include "tests/safety/supervisor_bench.h"

using namespace jaywalk;
using namespace jaywalk::supervised;

TEST_CASE("an emergency stop is latched until a reset edge at zero setpoint with the button out") {
  Bench bench;
  bench.input.emergency_stop = true;
  bench.ticks(3, {0.5, 0.0});
  bench.input.reset = true;  // pressed while the button is in: no edge later counts from this
  bench.tick({});
  bench.input.emergency_stop = false;
  CHECK(has(bench.ticks(3, {0.5, 0.0}).reasons, Reason::kLatched));
  bench.input.reset = false;
  bench.tick({});
  bench.input.reset = true;
  CHECK(has(bench.tick({0.5, 0.0}).reasons, Reason::kLatched));  // an edge, but not at zero
  bench.input.reset = false;
  bench.tick({});
  bench.input.reset = true;
  bench.tick({});
  CHECK(bench.supervisor.mode() != Mode::kLatched);
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
}

TEST_CASE("a pose in doubt is latched, and no reset moves the robot before it is known") {
  Bench bench;
  bench.ticks(30, {0.5, 0.0});
  bench.pose_doubtful = true;
  bench.ticks(50, {0.5, 0.0});
  bench.reset();
  const Verdict verdict = bench.ticks(10, {0.5, 0.0});
  CHECK(verdict.permitted == Twist2{});
  CHECK(verdict.reasons == (Reason::kPoseDoubtful | Reason::kLatched));
  bench.pose_doubtful = false;
  CHECK(bench.ticks(10, {0.5, 0.0}).permitted == Twist2{});
  bench.reset();
  CHECK(bench.ticks(10, {0.5, 0.0}).permitted.v_mps > 0.0);
}

TEST_CASE("no reset counts while the stick is out of its middle: nothing drives off with it") {
  Bench bench;
  bench.input.has_goal = false;
  bench.input.steers = true;
  bench.input.emergency_stop = true;
  bench.ticks(3, {});
  bench.input.emergency_stop = false;
  bench.input.stick = {1.0, 0.0};
  bench.input.reset = true;
  CHECK(has(bench.ticks(3, {}).reasons, Reason::kLatched));
  bench.input.reset = false;
  bench.input.stick = {};
  bench.tick({});
  bench.input.reset = true;
  bench.tick({});
  bench.input.stick = {0.5, 0.0};
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
  CHECK(bench.supervisor.mode() == Mode::kDriving);
  bench.input.stick = {};
  CHECK(has(bench.tick({}).reasons, Reason::kNoGoal));
}
