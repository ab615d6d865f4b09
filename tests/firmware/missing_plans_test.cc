// What the loop makes of plans without a path: one is bridged, a second of them stops the robot.
#include <algorithm>

#include "firmware/control_loop.h"
#include "firmware/recording/recorder.h"
#include "hal/sim/simulation.h"
#include "tests/firmware/failing_planner.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using jaywalk::test::FailingPlanner;

namespace {

struct Bench {
  explicit Bench(bool constant_speed) {
    setup.model = scenario.model;
    setup.constant_speed = constant_speed;
    setup.start = scenario.start;
    setup.goal = scenario.goal;
    planner = std::make_unique<FailingPlanner>(setup.planner());
    loop = std::make_unique<ControlLoop>(setup, simulation.hal(), *planner, recorder);
    ticks(200);  // four seconds: at speed
  }
  static sim::Scenario empty_hall() {
    sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_SCENARIOS) + "/crossing.toml");
    scenario.wanderers.clear();
    return scenario;
  }
  TickRecord ticks(int count) {
    TickRecord last;
    for (int k = 0; k < count; ++k) {
      recorder.drain();
      simulation.hal().clock.sleep_until(due += setup.tick());
      last = loop->tick(due);
      hardest_mps = std::max(hardest_mps, v_mps - last.verdict.permitted.v_mps);
      v_mps = last.verdict.permitted.v_mps;
    }
    return last;
  }

  sim::Scenario scenario = empty_hall();
  sim::Simulation simulation{scenario, 1};
  ControlSetup setup;
  Recorder recorder{{}};
  std::unique_ptr<FailingPlanner> planner;
  std::unique_ptr<ControlLoop> loop;
  Time due{};
  double v_mps = 0.0, hardest_mps = 0.0;  ///< permitted; the most that it fell in a tick
};

}  // namespace

TEST_CASE("one plan without a path is bridged within comfort, a second of them is a standstill") {
  Bench bench(false);
  const double before = bench.v_mps;
  REQUIRE(before > 0.5);
  bench.planner->fails = true;
  const TickRecord once = bench.ticks(4);  // a scan's time
  CHECK_FALSE(has(once.verdict.reasons, Reason::kPlanStale));
  CHECK(bench.v_mps > before - 0.06);
  bench.planner->fails = false;
  bench.ticks(50);
  CHECK(bench.v_mps > 0.5);
  CHECK(bench.hardest_mps <= bench.setup.model.limits.max_accel_mps2 * 0.02 + 1e-9);
  bench.planner->fails = true;
  const TickRecord last = bench.ticks(60);
  CHECK(has(last.verdict.reasons, Reason::kPlanStale));
  bench.ticks(60);
  CHECK(bench.v_mps == 0.0);
}

TEST_CASE("at constant speed, without a ramp of its own, a robot stops at the first plan without a path") {
  Bench bench(true);
  REQUIRE(bench.v_mps > 0.5);
  bench.planner->fails = true;
  const TickRecord last = bench.ticks(4);
  CHECK(has(last.verdict.reasons, Reason::kPlanStale));
  CHECK(bench.hardest_mps == Approx(bench.setup.model.limits.brake_mps2 * 0.02));
}
