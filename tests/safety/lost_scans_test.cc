// One scan may be lost, two in a row may not, whatever the rates of loop and scanner (SAFETY 3).
#include "firmware/safety/supervisor.h"
#include "tests/safety/scans.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Whether a fault comes of `lost` scans in a row that do not arrive, a second after the start. Scans arrive
/// `late_s` after they were measured; `phase` of a tick lies between the first tick and the first scan.
bool stops(double loop_hz, double scan_hz, int lost, double phase, double late_s = 0.001) {
  RobotModel model = p3dx();
  model.laser.rate_hz = scan_hz;
  Supervisor supervisor({.model = model, .tick = duration_from_seconds(1.0 / loop_hz), .latches_all = true});
  LaserScan scan = tests::scan_of(model.laser, 10.0F);
  OperatorInput input;
  input.has_goal = true;
  WheelState wheels;
  const int first_lost = 2 * static_cast<int>(scan_hz) + 1;
  for (int k = 0; k < static_cast<int>(3.0 * loop_hz); ++k) {
    const double now_s = 1.0 + (k + phase) / loop_hz;
    const Time now = time_from_seconds(now_s);
    int newest = static_cast<int>((now_s - late_s) * scan_hz + 1e-9);
    if (newest >= first_lost && newest < first_lost + lost) newest = first_lost - 1;
    const int missing = newest >= first_lost + lost ? lost : 0;
    scan.stamp = time_from_seconds(newest / scan_hz);
    scan.sequence = static_cast<std::uint32_t>(newest - missing);
    wheels.stamp = now;
    ++wheels.sequence;
    static_cast<void>(supervisor.judge({0.1, 0.0}, {scan, wheels, input, now, now}));
  }
  return supervisor.mode() == Mode::kLatched;
}

}  // namespace

TEST_CASE("one lost scan passes and two in a row stop, from 20 to 200 Hz and from 5 to 50 scans a second") {
  const double loop_hz = GENERATE(20.0, 30.0, 50.0, 100.0, 200.0);
  const double scan_hz = GENERATE(5.0, 7.0, 10.0, 15.0, 25.0, 40.0, 50.0);
  const double phase = GENERATE(0.0, 0.25, 0.5, 0.75);
  CAPTURE(loop_hz, scan_hz, phase);
  CHECK_FALSE(stops(loop_hz, scan_hz, 0, phase));
  CHECK_FALSE(stops(loop_hz, scan_hz, 1, phase));
  CHECK(stops(loop_hz, scan_hz, 2, phase));
}
