// Orders to stop, clients that go on asking for motion, and resets. What moves is the far end's: both wheels, in truth.
#include "tests/robot/joystick_pipe.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;

namespace {

constexpr const char *kGoal = "goto 9 8", *kOther = "goto 9 7", *kThird = "goto 8 7";

/// A client that says its goal once a second, for so many seconds.
void repeat_goal(Bench& bench, int seconds) {
  for (int k = 0; k < seconds; ++k) {
    static_cast<void>(bench.obey(kGoal));
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
    bench.go(150, kGoal);
    REQUIRE(bench.speed_mps() > 0.05);  // an LD19 does not reach across the hall: held to 0.1 m/s there
    CHECK(bench.obey("stop") == "stopping\n");
    CHECK(bench.obey(kOther) == "refused: the robot is still stopping; give the goal when it stands\n");
    CHECK(comes_to_rest(bench, [&] { CHECK(bench.obey(kOther).starts_with("refused")); }));
    CHECK(bench.speed_after(10) == 0.0);
    bench.go(100, kThird);
    CHECK(bench.speed_mps() > 0.05);
  }
}

TEST_CASE("a client that goes on repeating its goal does not start the robot after a stop", "[stop]") {
  Bench bench("robot");
  bench.tick(10);
  repeat_goal(bench, 3);
  REQUIRE(bench.speed_mps() > 0.3);
  CHECK(bench.obey("stop") == "stopping\n");
  CHECK(comes_to_rest(bench, [&] { static_cast<void>(bench.obey(kGoal)); }));
  for (int k = 0; k < 10; ++k) {
    CHECK(bench.obey(kGoal).starts_with("refused"));
    CHECK(bench.speed_after(50) == 0.0);
  }
  SECTION("another client's goal counts") { CHECK(bench.obey(kOther) == "going\n"); }
  SECTION("so does the same goal, given anew") {
    bench.tick(300);
    CHECK(bench.obey(kGoal) == "going\n");
  }
  CHECK(bench.speed_after(100) > 0.3);
}

TEST_CASE("nor after an emergency stop or a fault, when the robot is reset", "[stop]") {
  Bench bench("robot");
  bench.tick(10);
  repeat_goal(bench, 3);
  CHECK(bench.obey("stop now") == "stopping\n");
  repeat_goal(bench, 3);
  CHECK(bench.obey("reset") == "reset\n");
  bench.tick(5);
  REQUIRE_FALSE(bench.is_latched());
  repeat_goal(bench, 3);
  CHECK(bench.speed_mps() == 0.0);
}

TEST_CASE("a stick that is held, or let go and pushed on the way to rest, waits for its middle at rest", "[stop]") {
  for (const bool is_let_go : {false, true}) {
    tests::JoystickPipe joystick;
    Bench bench("robot", panel::JoystickSetup{.path = joystick.path}, 50, StickUse::kShared);
    bench.tick(10);
    joystick.take_dead_man();
    bench.tick(5);
    joystick.push(32767);
    REQUIRE(bench.speed_after(200) > 0.3);
    CHECK(bench.obey("stop") == "stopping\n");
    bench.tick(5);
    if (is_let_go) joystick.push(0);
    bench.tick(5);
    if (is_let_go) joystick.push(32767);
    CHECK(comes_to_rest(bench, [] {}));
    CHECK(bench.speed_after(100) == 0.0);
    joystick.push_from_middle(bench);
    CHECK(bench.speed_after(100) > 0.3);
  }
}

TEST_CASE("a reset while the cause of a stop still shows is refused by its name", "[stop]") {
  Bench bench("robot");
  bench.tick(10);
  bench.go(100, kGoal);
  bench.far_end().scanner().order(emulators::ScannerFault::kSilence, 60s);
  REQUIRE(bench.speed_after(150) == 0.0);
  CHECK(bench.obey("reset") == "refused: still scan_stale; see to it, then jaywalk reset\n");
  bench.tick(5);
  CHECK(bench.is_latched());
}

TEST_CASE("a reset is refused while a drive is unplugged, and taken once its plug is back", "[stop]") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    CAPTURE(robot);
    Bench bench(robot);
    bench.tick(25);
    bench.go(100, kGoal);
    bench.far_end().drive(1).pull_cable();
    bench.tick(100);
    CHECK(bench.is_latched());
    CHECK(bench.obey("reset") ==
          "refused: still drive: one says nothing; see to its cable and power, then jaywalk reset\n");
    bench.tick(5);
    CHECK(bench.is_latched());
    bench.far_end().drive(1).plug_cable();
    bench.tick(100);
    CHECK(bench.obey("reset") == "reset\n");
    bench.tick(300);
    CHECK_FALSE(bench.is_latched());
  }
}

TEST_CASE(
    "a stranger that takes a drive out of operation latches, and a reset proves both drives before anything moves") {
  Bench bench("robot");
  bench.tick(10);
  bench.go(150);
  REQUIRE(bench.speed_mps() > 0.3);
  CHECK(bench.robot.wires().port(3).send({.id = 0x000, .size = 2, .bytes = {0x80, 2}}));
  bench.tick();
  CHECK(bench.shows(Reason::kForeignMaster));
  CHECK(bench.speed_after(35) == 0.0);
  CHECK(bench.last().wheels.stop == StopStage::kSilent);
  const std::string status = bench.status();
  CHECK(holds(status, "\nbackend: cpu\n"));
  CHECK(holds(status, "\nlatched_by: foreign_master\n"));
  CHECK(holds(status, "\nforeign_frame: 000#8002\n"));
  bench.tick(30);

  CHECK(bench.obey("reset") == "reset\n");
  bench.tick(2);
  CHECK(bench.is_latched());
  CHECK(bench.obey("goto 9 8") == "refused: the drives are being proved again; try again in some seconds\n");
  int ticks = 0;
  bench.heap_calls = 0;
  for (; ticks < 250 && bench.is_latched(); ++ticks) bench.tick();
  CHECK(ticks > 20);
  CHECK(ticks < 250);
  CHECK(bench.heap_calls == 0);
  CHECK(bench.speed_mps() == 0.0);
  bench.tick(20);
  CHECK(bench.status().starts_with("state: waiting\n"));
  bench.go(200);  // the wheels are proved first
  CHECK(bench.speed_mps() > 0.3);
}

TEST_CASE("after an emergency stop that cut a drive's power a reset proves the drives anew and the robot drives") {
  for (const char* robot : {"odrive_hokuyo", "vesc_ld19"}) {
    Bench bench(robot);
    bench.tick(25);
    bench.go(150);
    CHECK(bench.speed_mps() > 0.05);  // an LD19 does not reach across the hall: held to 0.1 m/s there
    CHECK(bench.obey("stop now").starts_with("stop"));
    bench.tick(100);
    bench.far_end().drive(0).pull_cable();
    CHECK(bench.speed_after(50) == 0.0);
    CHECK(bench.last().wheels.trouble == DriveTrouble::kDriveSilent);
    CHECK(bench.last().wheels.stop == StopStage::kSilent);
    bench.far_end().drive(0).plug_cable();
    bench.tick(50);
    bench.heap_calls = 0;
    CHECK(bench.obey("reset").starts_with("reset"));
    bench.tick(60);
    CHECK(bench.heap_calls == 0);
    CHECK(bench.robot.drive().is_proved());
    CHECK_FALSE(bench.is_latched());
    CHECK(bench.speed_mps() == 0.0);
    CHECK(bench.obey("goto 9 8") == "going\n");
    const Vec2 from = bench.last().pose.map_from_robot.position();
    bench.tick(150);
    CHECK(distance(bench.last().pose.map_from_robot.position(), from) > 0.15);  // the LD19's is held to 0.1 m/s there
  }
}
