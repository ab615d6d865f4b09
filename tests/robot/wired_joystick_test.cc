// The whole controller with a joystick in front of it.
#include "tests/robot/joystick_pipe.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;
using Joystick = tests::JoystickPipe;

TEST_CASE("with a joystick the robot drives while its dead man is held, and its stop and reset are the robot's") {
  Joystick joystick;
  Bench bench("robot", panel::JoystickSetup{.path = joystick.path});
  bench.tick(10);
  bench.go(50);
  CHECK(bench.speed_mps() == 0.0);
  joystick.take_dead_man();             // a button that was never seen released is tied down
  CHECK(bench.speed_after(200) > 0.3);  // the wheels are proved first
  joystick.press(BTN_TL, false);
  CHECK(bench.speed_after(100) == 0.0);
  CHECK(bench.shows(Reason::kNoGoal));
  CHECK_FALSE(bench.is_latched());
  joystick.press(BTN_TL);
  CHECK(bench.speed_after(100) > 0.3);

  joystick.press(BTN_EAST);
  CHECK(bench.speed_after(100) == 0.0);
  joystick.press(BTN_EAST, false);
  bench.tick(50);
  CHECK(bench.is_latched());
  joystick.press(BTN_START);
  bench.tick(50);
  CHECK_FALSE(bench.is_latched());
  CHECK(bench.speed_mps() == 0.0);  // the goal went with the stop
  bench.go(0);
  CHECK(bench.tick_until(600, [&] { return bench.speed_mps() >= 0.3; }));
  joystick.pull();
  CHECK(bench.speed_after(100) == 0.0);
  CHECK(bench.shows(Reason::kEmergencyStop));
}

TEST_CASE("by the stick, shared or by hand, the robot drives while its dead man is held, in the middle it stands") {
  for (const StickUse steering : {StickUse::kShared, StickUse::kByHand}) {
    Joystick joystick;
    Bench bench("robot", panel::JoystickSetup{.path = joystick.path}, 50, steering);
    bench.tick(10);
    joystick.push(32767);
    CHECK(bench.speed_after(50) == 0.0);
    joystick.take_dead_man();
    CHECK(bench.speed_after(100) == 0.0);  // the stick was pushed before: it counts from its middle on
    joystick.push_from_middle(bench);
    // Its wheels are proved on the first way.
    CHECK(bench.tick_until(600, [&] { return bench.speed_mps() >= 0.4; }));
    CHECK(holds(bench.status(), "state: steered\n"));
    joystick.push(0);
    CHECK(bench.speed_after(160) == 0.0);
    joystick.push(32767);
    CHECK(bench.speed_after(100) > 0.3);
    joystick.press(BTN_TL, false);
    CHECK(bench.speed_after(120) == 0.0);
    CHECK_FALSE(bench.is_latched());
    CHECK(bench.heap_calls == 0);
  }
}

TEST_CASE("who takes the stick drops the goal, jaywalk stop and a latched fault hold the stick until its middle") {
  Joystick joystick;
  Bench bench("robot", panel::JoystickSetup{.path = joystick.path}, 50, StickUse::kShared);
  bench.tick(10);
  joystick.take_dead_man();
  bench.go(0);
  CHECK(bench.tick_until(600, [&] { return bench.speed_mps() >= 0.3; }));
  joystick.push(16000);
  bench.tick(5);
  joystick.push(0);
  CHECK(bench.speed_after(120) == 0.0);  // it goes on to nowhere
  joystick.push(32767);
  CHECK(bench.speed_after(100) > 0.3);
  CHECK(bench.obey("stop") == "stopping\n");
  CHECK(bench.speed_after(120) == 0.0);
  joystick.press(BTN_EAST);
  bench.tick(5);
  joystick.press(BTN_EAST, false);
  joystick.push_from_middle(bench);
  bench.tick(5);
  joystick.press(BTN_START);
  CHECK(bench.speed_after(50) == 0.0);
  CHECK(bench.is_latched());
  joystick.press(BTN_START, false);
  joystick.push(0);
  bench.tick(5);
  joystick.press(BTN_START);
  bench.tick(5);
  joystick.push(32767);
  CHECK(bench.speed_after(100) > 0.3);
}
