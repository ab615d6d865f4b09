// The whole controller with a joystick in front of it.
#include "tests/robot/joystick_pipe.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;
using Joystick = tests::JoystickPipe;

TEST_CASE("with a joystick the robot drives while its dead man is held, and its stop and reset are the robot's") {
  Joystick joystick;
  Bench bench("robot", PanelWiring{.joystick = {.path = joystick.path}});
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(50);
  CHECK(bench.speed_mps() == 0.0);
  joystick.press(BTN_TL, false);  // a button that was never seen released is tied down
  joystick.press(BTN_TL);
  bench.tick(200);  // the wheels are proved first
  CHECK(bench.speed_mps() > 0.3);
  joystick.press(BTN_TL, false);
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(has(bench.last().verdict.reasons, Reason::kNoGoal));
  CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
  joystick.press(BTN_TL);
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);

  joystick.press(BTN_EAST);
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  joystick.press(BTN_EAST, false);
  bench.tick(50);
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  joystick.press(BTN_START);
  bench.tick(50);
  CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
  CHECK(bench.speed_mps() == 0.0);  // the goal went with the stop
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  for (int k = 0; k < 600 && bench.speed_mps() < 0.3; ++k) bench.tick();
  CHECK(bench.speed_mps() >= 0.3);
  joystick.pull();
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(has(bench.last().verdict.reasons, Reason::kEmergencyStop));
}

TEST_CASE("by the stick, shared or by hand, the robot drives while its dead man is held, in the middle it stands") {
  for (const StickUse steering : {StickUse::kShared, StickUse::kByHand}) {
    Joystick joystick;
    Bench bench("robot", PanelWiring{.joystick = {.path = joystick.path}}, 50, steering);
    bench.tick(10);
    joystick.push(32767);
    bench.tick(50);
    CHECK(bench.speed_mps() == 0.0);
    joystick.press(BTN_TL, false);
    joystick.press(BTN_TL);
    bench.tick(100);
    CHECK(bench.speed_mps() == 0.0);  // the stick was pushed before: it counts from its middle on
    joystick.push(0);
    bench.tick(5);
    joystick.push(32767);
    for (int k = 0; k < 600 && bench.speed_mps() < 0.4; ++k) bench.tick();  // its wheels are proved on the first way
    CHECK(bench.speed_mps() >= 0.4);
    CHECK(bench.robot.desk().obey("status").find("state: steered\n") != std::string::npos);
    joystick.push(0);
    bench.tick(160);
    CHECK(bench.speed_mps() == 0.0);
    joystick.push(32767);
    bench.tick(100);
    CHECK(bench.speed_mps() > 0.3);
    joystick.press(BTN_TL, false);
    bench.tick(120);
    CHECK(bench.speed_mps() == 0.0);
    CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
    CHECK(bench.heap_calls == 0);
  }
}

TEST_CASE("who takes the stick drops the goal, jaywalk stop and a latched fault hold the stick until its middle") {
  Joystick joystick;
  Bench bench("robot", PanelWiring{.joystick = {.path = joystick.path}}, 50, StickUse::kShared);
  bench.tick(10);
  joystick.press(BTN_TL, false);
  joystick.press(BTN_TL);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  for (int k = 0; k < 600 && bench.speed_mps() < 0.3; ++k) bench.tick();
  CHECK(bench.speed_mps() >= 0.3);
  joystick.push(16000);
  bench.tick(5);
  joystick.push(0);
  bench.tick(120);
  CHECK(bench.speed_mps() == 0.0);  // it goes on to nowhere
  joystick.push(32767);
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);
  CHECK(bench.robot.desk().obey("stop") == "stopping\n");
  bench.tick(120);
  CHECK(bench.speed_mps() == 0.0);
  joystick.press(BTN_EAST);
  bench.tick(5);
  joystick.press(BTN_EAST, false);
  joystick.push(0);
  bench.tick(5);
  joystick.push(32767);
  bench.tick(5);
  joystick.press(BTN_START);
  bench.tick(50);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  joystick.press(BTN_START, false);
  joystick.push(0);
  bench.tick(5);
  joystick.press(BTN_START);
  bench.tick(5);
  joystick.push(32767);
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);
}
