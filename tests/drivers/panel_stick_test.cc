// A joystick's stick: when it drives, and when it does not.
#include <linux/input.h>

#include "tests/drivers/panel_bench.h"

using namespace jaywalk;
using namespace jaywalk::panel;
using namespace jaywalk::panel::tests;

TEST_CASE("sticks count from a dead zone to the end while the dead man's button is held") {
  Bench bench;
  bench.plug_in();
  static_cast<void>(bench.after(0ms));
  bench.write(event(EV_ABS, kY, -32767));
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().forward == 0.0);
  bench.press(kDeadMan, false);
  bench.press(kDeadMan);
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().dead_man);
  CHECK(bench.watch.latest().forward == 0.0);  // pushed before: it has to come to its middle first
  bench.write(event(EV_ABS, kY, 0));
  static_cast<void>(bench.after(20ms));
  bench.write(event(EV_ABS, kY, -32767));
  bench.write(event(EV_ABS, kX, 3276));  // a tenth to the right: at rest
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().forward == Approx(1.0));
  CHECK(bench.watch.latest().left == 0.0);
  bench.write(event(EV_ABS, kX, -18022));  // 0.55 to the left: (0.55 - 0.1) / 0.9
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().left == Approx(0.5).margin(1e-4));
}

TEST_CASE("where the stick drives it takes the goal's place when it leaves its middle, while the dead man is held") {
  Bench bench(false, 0s, bus_of, true);
  bench.plug_in();
  static_cast<void>(bench.after(0ms));
  bench.press(kDeadMan, false);
  bench.press(kDeadMan);
  OperatorInput input = bench.after(20ms);
  CHECK(input.has_goal);  // the stick rests: what was asked for elsewhere counts
  CHECK_FALSE(input.steers);
  bench.write(event(EV_ABS, kY, -32767));
  input = bench.after(20ms);
  CHECK_FALSE(input.has_goal);
  CHECK(input.steers);
  CHECK(input.stick.forward == Approx(1.0));
  bench.press(kDeadMan, false);
  input = bench.after(20ms);
  CHECK(input.stick.is_centred());
  CHECK_FALSE(input.wants_motion());
}
