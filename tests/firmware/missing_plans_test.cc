// What the loop makes of plans without a path: one is bridged, a second of them stops the robot.
#include <algorithm>

#include "tests/firmware/failing_planner.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Bench {
  explicit Bench(bool constant_speed)
      : drive([](sim::Scenario& scenario) { scenario.wanderers.clear(); }, constant_speed) {
    ticks(200);  // four seconds: at speed
  }
  TickRecord ticks(int count) {
    TickRecord last;
    for (int k = 0; k < count; ++k) {
      last = drive.tick();
      hardest_mps = std::max(hardest_mps, v_mps - last.verdict.permitted.v_mps);
      v_mps = last.verdict.permitted.v_mps;
    }
    return last;
  }

  test::FailingDrive drive;
  double v_mps = 0.0, hardest_mps = 0.0;  ///< permitted; the most that it fell in a tick
};

}  // namespace

TEST_CASE("one plan without a path is bridged within comfort, a second of them is a standstill") {
  Bench bench(false);
  const double before = bench.v_mps;
  REQUIRE(before > 0.5);
  bench.drive.fail(true);
  const TickRecord once = bench.ticks(4);  // a scan's time
  CHECK_FALSE(has(once.verdict.reasons, Reason::kPlanStale));
  CHECK(bench.v_mps > before - 0.06);
  bench.drive.fail(false);
  bench.ticks(50);
  CHECK(bench.v_mps > 0.5);
  CHECK(bench.hardest_mps <= bench.drive.setup().model.limits.max_accel_mps2 * 0.02 + 1e-9);
  bench.drive.fail(true);
  const TickRecord last = bench.ticks(60);
  CHECK(has(last.verdict.reasons, Reason::kPlanStale));
  bench.ticks(60);
  CHECK(bench.v_mps == 0.0);
}

TEST_CASE("at constant speed, without a ramp of its own, a robot stops at the first plan without a path") {
  Bench bench(true);
  REQUIRE(bench.v_mps > 0.5);
  bench.drive.fail(true);
  const TickRecord last = bench.ticks(4);
  CHECK(has(last.verdict.reasons, Reason::kPlanStale));
  CHECK(bench.hardest_mps == Approx(bench.drive.setup().model.limits.brake_mps2 * 0.02));
}
