// Where the controller believes it is after it was stopped under way (SIGSTOP, a debugger, a board out of memory).
#include <cmath>

#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;

namespace {

/// The process does not run for so long: no tick, and nothing is taken from the wires.
void stall(Bench& bench, Duration time) {
  const auto live = std::exchange(bench.clock.live, [&bench] { bench.robot.step_far_end(); });
  bench.due += time;
  bench.clock.sleep_until(bench.due);
  bench.clock.live = live;
}

}  // namespace

TEST_CASE("after a stall under way the pose is right again, or in doubt, before anything drives") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    for (const Duration time : {500ms, 1000ms, 3000ms, 5000ms}) {
      for (const char* goal : {"goto 9 8", "goto 3 12"}) {
        CAPTURE(robot, to_seconds(time), goal);
        Bench bench(robot);
        bench.tick(10);
        bench.go(200, goal);
        stall(bench, time);
        CHECK(bench.speed_after(400) == 0.0);  // an ODrive without commands lets its wheel roll out
        CHECK((bench.off_m() < 0.05 || bench.is_doubtful()));
        bench.reset();
        bench.tick(20);
        // A restart may be among frames that were lost.
        if (bench.robot.wires().port(0).health().frames_lost > 0 && bench.is_doubtful()) {
          CHECK(bench.is_latched());
          continue;
        }
        CHECK_FALSE(bench.is_latched());
        CHECK(bench.off_m() < 0.05);
        CHECK(bench.off_rad() < 0.02);
      }
    }
  }
}

TEST_CASE("a drive that restarted in a stall leaves the pose in doubt until a person says where the robot is") {
  Bench bench("robot");
  bench.tick(10);
  bench.go(300);
  bench.far_end().drive(0).restart();
  stall(bench, 3000ms);
  REQUIRE(bench.speed_after(100) == 0.0);
  CHECK(bench.is_doubtful());
  bench.reset();
  bench.tick(50);
  CHECK(bench.is_doubtful());
  CHECK(bench.is_latched());
  CHECK(bench.obey("goto 9 8").starts_with("refused"));
  CHECK(bench.obey("reset").starts_with("refused: nobody knows where the robot is"));

  const Pose2 there = bench.truth();
  CHECK(bench.obey("here 1 2") == "refused: here: say one place, and its heading\n");
  const std::string words = tests::here({there.x + 0.1, there.y - 0.1, there.heading + 0.05});
  CHECK(tests::say(bench, words) == "there\n");
  bench.tick(20);
  CHECK_FALSE(bench.is_doubtful());
  CHECK(bench.is_latched());
  bench.reset();
  bench.tick(50);
  CHECK(bench.off_m() < 0.05);
  CHECK(bench.off_rad() < 0.02);
  bench.go(0);
  CHECK(bench.tick_until(400, [&] { return bench.speed_mps() >= 0.2; }));
  CHECK(bench.obey(words) == "refused: the robot still moves; try again when it stands\n");
}
