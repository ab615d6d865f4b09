// Resets of the whole controller, after drives were in trouble and after they were not.
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;

TEST_CASE(
    "a stranger that takes a drive out of operation latches, and a reset proves both drives before anything moves") {
  Bench bench("robot");
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(150);
  REQUIRE(bench.speed_mps() > 0.3);
  CHECK(bench.robot.wires().port(3).send({.id = 0x000, .size = 2, .bytes = {0x80, 2}}) == SendResult::kQueued);
  bench.tick();
  CHECK(has(bench.last().verdict.reasons, Reason::kForeignMaster));
  bench.tick(35);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(bench.last().wheels.stop == StopStage::kSilent);
  const std::string status = bench.robot.desk().obey("status");
  CHECK(status.find("\nbackend: cpu\n") != std::string::npos);
  CHECK(status.find("\nlatched_by: foreign_master\n") != std::string::npos);
  CHECK(status.find("\nforeign_frame: 000#8002\n") != std::string::npos);
  bench.tick(30);

  CHECK(bench.robot.desk().obey("reset") == "reset\n");
  bench.tick(2);
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  CHECK(bench.robot.desk().obey("goto 9 8") ==
        "refused: the drives are being proved again; try again in some seconds\n");
  int ticks = 0;
  bench.heap_calls = 0;
  for (; ticks < 250 && has(bench.last().verdict.reasons, Reason::kLatched); ++ticks) bench.tick();
  CHECK(ticks > 20);
  CHECK(ticks < 250);
  CHECK(bench.heap_calls == 0);
  CHECK(bench.speed_mps() == 0.0);
  bench.tick(20);
  CHECK(bench.robot.desk().obey("status").rfind("state: waiting\n", 0) == 0);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(200);  // the wheels are proved first
  CHECK(bench.speed_mps() > 0.3);
}

TEST_CASE("an emergency stop over the desk, and a reset after it, ask the drives for no proof") {
  Bench bench("robot");
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(150);
  CHECK(bench.robot.desk().obey("stop now") == "stopping\n");
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(bench.last().wheels.stop == StopStage::kNone);
  CHECK(bench.robot.drive().is_proved());
  CHECK(bench.robot.desk().obey("reset") == "reset\n");
  bench.tick();
  CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
}

TEST_CASE("after an emergency stop that cut a drive's power a reset proves the drives anew and the robot drives") {
  for (const char* robot : {"odrive_hokuyo", "vesc_ld19"}) {
    Bench bench(robot);
    bench.tick(25);
    CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
    bench.tick(150);
    CHECK(bench.speed_mps() > 0.05);  // an LD19 does not reach across the hall: held to 0.1 m/s there
    CHECK(bench.robot.desk().obey("stop now").rfind("stop", 0) == 0);
    bench.tick(100);
    bench.robot.far_end().drive(0).pull_cable();
    bench.tick(50);
    CHECK(bench.speed_mps() == 0.0);
    CHECK(bench.last().wheels.trouble == DriveTrouble::kDriveSilent);
    CHECK(bench.last().wheels.stop == StopStage::kSilent);
    bench.robot.far_end().drive(0).plug_cable();
    bench.tick(50);
    bench.heap_calls = 0;
    CHECK(bench.robot.desk().obey("reset").rfind("reset", 0) == 0);
    bench.tick(60);
    CHECK(bench.heap_calls == 0);
    CHECK(bench.robot.drive().is_proved());
    CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
    CHECK(bench.speed_mps() == 0.0);
    CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
    const Vec2 from = bench.last().pose.map_from_robot.position();
    bench.tick(150);
    CHECK(distance(bench.last().pose.map_from_robot.position(), from) > 0.15);  // the LD19's is held to 0.1 m/s there
  }
}
