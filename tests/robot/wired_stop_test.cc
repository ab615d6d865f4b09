// Orders to stop, and clients that go on asking for motion. What moves is the far end's: both wheels, in truth.
#include "tests/robot/joystick_pipe.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;

namespace {

constexpr const char *kGoal = "goto 9 8", *kOther = "goto 9 7", *kThird = "goto 8 7";

std::string say(Bench& bench, const char* line) { return bench.robot.desk().obey(line); }

/// A client that says its goal once a second, for so many seconds.
void repeat_goal(Bench& bench, int seconds) {
  for (int k = 0; k < seconds; ++k) {
    static_cast<void>(say(bench, kGoal));
    bench.tick(50);
  }
}

/// Ticks until both wheels stand; true where they do within 3 s and never turned faster meanwhile.
template <class Meanwhile>
bool comes_to_rest(Bench& bench, Meanwhile meanwhile) {
  double before_mps = bench.speed_mps();
  for (int k = 0; k < 150 && bench.speed_mps() > 0.0; ++k) {
    meanwhile();
    bench.tick();
    if (k >= 5 && bench.speed_mps() > before_mps + 0.01) return false;
    before_mps = bench.speed_mps();
  }
  return bench.speed_mps() == 0.0;
}

}  // namespace

TEST_CASE("a stop is obeyed to rest whatever is said meanwhile, and what is said at rest counts", "[stop]") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    Bench bench(robot);
    bench.tick(25);
    CHECK(say(bench, kGoal) == "going\n");
    bench.tick(150);
    REQUIRE(bench.speed_mps() > 0.05);  // an LD19 does not reach across the hall: held to 0.1 m/s there
    CHECK(say(bench, "stop") == "stopping\n");
    CHECK(say(bench, kOther) == "refused: the robot is still stopping; give the goal when it stands\n");
    CHECK(comes_to_rest(bench, [&] { CHECK(say(bench, kOther).starts_with("refused")); }));
    bench.tick(10);
    CHECK(bench.speed_mps() == 0.0);
    CHECK(say(bench, kThird) == "going\n");
    bench.tick(100);
    CHECK(bench.speed_mps() > 0.05);
  }
}

TEST_CASE("a client that goes on repeating its goal does not start the robot after a stop", "[stop]") {
  Bench bench("robot");
  bench.tick(10);
  repeat_goal(bench, 3);
  REQUIRE(bench.speed_mps() > 0.3);
  CHECK(say(bench, "stop") == "stopping\n");
  CHECK(comes_to_rest(bench, [&] { static_cast<void>(say(bench, kGoal)); }));
  for (int k = 0; k < 10; ++k) {
    CHECK(say(bench, kGoal).starts_with("refused"));
    bench.tick(50);
    CHECK(bench.speed_mps() == 0.0);
  }
  SECTION("another client's goal counts") { CHECK(say(bench, kOther) == "going\n"); }
  SECTION("so does the same goal, given anew") {
    bench.tick(300);
    CHECK(say(bench, kGoal) == "going\n");
  }
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);
}

TEST_CASE("nor after an emergency stop or a fault, when the robot is reset", "[stop]") {
  Bench bench("robot");
  bench.tick(10);
  repeat_goal(bench, 3);
  CHECK(say(bench, "stop now") == "stopping\n");
  repeat_goal(bench, 3);
  CHECK(say(bench, "reset") == "reset\n");
  bench.tick(5);
  REQUIRE_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
  repeat_goal(bench, 3);
  CHECK(bench.speed_mps() == 0.0);
}

TEST_CASE("a stick that is held, or let go and pushed on the way to rest, waits for its middle at rest", "[stop]") {
  for (const bool is_let_go : {false, true}) {
    tests::JoystickPipe joystick;
    Bench bench("robot", PanelWiring{.joystick = {.path = joystick.path}}, 50, StickUse::kShared);
    bench.tick(10);
    joystick.press(BTN_TL, false);
    joystick.press(BTN_TL);
    bench.tick(5);
    joystick.push(32767);
    bench.tick(200);
    REQUIRE(bench.speed_mps() > 0.3);
    CHECK(say(bench, "stop") == "stopping\n");
    bench.tick(5);
    if (is_let_go) joystick.push(0);
    bench.tick(5);
    if (is_let_go) joystick.push(32767);
    CHECK(comes_to_rest(bench, [] {}));
    bench.tick(100);
    CHECK(bench.speed_mps() == 0.0);
    joystick.push(0);
    bench.tick(5);
    joystick.push(32767);
    bench.tick(100);
    CHECK(bench.speed_mps() > 0.3);
  }
}

TEST_CASE("a reset while the cause of a stop still shows is refused by its name", "[stop]") {
  Bench bench("robot");
  bench.tick(10);
  CHECK(say(bench, kGoal) == "going\n");
  bench.tick(100);
  bench.robot.far_end().scanner().order(emulators::ScannerFault::kSilence, 60s);
  bench.tick(150);
  REQUIRE(bench.speed_mps() == 0.0);
  CHECK(say(bench, "reset") == "refused: still scan_stale; see to it, then jaywalk reset\n");
  bench.tick(5);
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
}

TEST_CASE("a reset is refused while a drive is unplugged, and taken once its plug is back", "[stop]") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    CAPTURE(robot);
    Bench bench(robot);
    bench.tick(25);
    CHECK(say(bench, kGoal) == "going\n");
    bench.tick(100);
    bench.robot.far_end().drive(1).pull_cable();
    bench.tick(100);
    CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
    CHECK(say(bench, "reset") ==
          "refused: still drive: one says nothing; see to its cable and power, then jaywalk reset\n");
    bench.tick(5);
    CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
    bench.robot.far_end().drive(1).plug_cable();
    bench.tick(100);
    CHECK(say(bench, "reset") == "reset\n");
    bench.tick(300);
    CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
  }
}
