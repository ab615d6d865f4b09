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

[[nodiscard]] double off_m(Bench& bench) {
  return distance(bench.last().pose.map_from_robot.position(), bench.robot.far_end().truth().map_from_robot.position());
}

[[nodiscard]] double off_rad(Bench& bench) {
  return std::fabs(
      wrap_angle(bench.last().pose.map_from_robot.heading - bench.robot.far_end().truth().map_from_robot.heading));
}

/// A person resets, and waits until the drives are proved.
void reset(Bench& bench) {
  CHECK(bench.robot.desk().obey("reset") == "reset\n");
  for (int k = 0; k < 300 && has(bench.last().verdict.reasons, Reason::kLatched); ++k) bench.tick();
}

[[nodiscard]] bool doubtful(Bench& bench) { return has(bench.last().verdict.reasons, Reason::kPoseDoubtful); }

}  // namespace

TEST_CASE("after a stall under way the pose is right again, or in doubt, before anything drives") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    for (const Duration time : {500ms, 1000ms, 3000ms, 5000ms}) {
      for (const char* goal : {"goto 9 8", "goto 3 12"}) {
        CAPTURE(robot, to_seconds(time), goal);
        Bench bench(robot);
        bench.tick(10);
        REQUIRE(bench.robot.desk().obey(goal) == "going\n");
        bench.tick(200);
        stall(bench, time);
        bench.tick(400);  // an ODrive without commands lets its wheel roll out
        CHECK(bench.speed_mps() == 0.0);
        CHECK((off_m(bench) < 0.05 || doubtful(bench)));
        reset(bench);
        bench.tick(20);
        if (bench.robot.wires().port(0).health().frames_lost > 0 && doubtful(bench)) {  // a restart may be among them
          CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
          continue;
        }
        CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
        CHECK(off_m(bench) < 0.05);
        CHECK(off_rad(bench) < 0.02);
      }
    }
  }
}

TEST_CASE("a drive that restarted in a stall leaves the pose in doubt until a person says where the robot is") {
  Bench bench("robot");
  bench.tick(10);
  REQUIRE(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(300);
  bench.robot.far_end().drive(0).restart();
  stall(bench, 3000ms);
  bench.tick(100);
  REQUIRE(bench.speed_mps() == 0.0);
  CHECK(doubtful(bench));
  reset(bench);
  bench.tick(50);
  CHECK(doubtful(bench));
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  CHECK(bench.robot.desk().obey("goto 9 8").starts_with("refused"));
  CHECK(bench.robot.desk().obey("reset").starts_with("refused: nobody knows where the robot is"));

  const Pose2 there = bench.robot.far_end().truth().map_from_robot;
  char words[100];
  std::snprintf(words, sizeof words, "here %.2f %.2f", there.x + 0.1, there.y - 0.1);
  CHECK(bench.robot.desk().obey(words) == "refused: here: say one place, and its heading\n");
  std::snprintf(words, sizeof words, "here %.2f %.2f %.2f", there.x + 0.1, there.y - 0.1, there.heading + 0.05);
  CHECK(tests::say(bench, words) == "there\n");
  bench.tick(20);
  CHECK_FALSE(doubtful(bench));
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  reset(bench);
  bench.tick(50);
  CHECK(off_m(bench) < 0.05);
  CHECK(off_rad(bench) < 0.02);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  for (int k = 0; k < 400 && bench.speed_mps() < 0.2; ++k) bench.tick();
  CHECK(bench.speed_mps() >= 0.2);
  CHECK(bench.robot.desk().obey(words) == "refused: the robot still moves; try again when it stands\n");
}
