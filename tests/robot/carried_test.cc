// A robot at rest that is lifted, carried and turned by hand: told, nothing moves, and its place is found again or it
// stays in doubt.
#include <cmath>

#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using Bench = tests::WiredBench;

namespace {

[[nodiscard]] double off_m(Bench& bench) {
  return distance(bench.last().pose.map_from_robot.position(), bench.robot.far_end().truth().map_from_robot.position());
}
[[nodiscard]] double off_rad(Bench& bench) {
  return std::fabs(
      wrap_angle(bench.last().pose.map_from_robot.heading - bench.robot.far_end().truth().map_from_robot.heading));
}
[[nodiscard]] bool doubtful(Bench& bench) { return has(bench.last().verdict.reasons, Reason::kPoseDoubtful); }

/// In steps of 2 cm and a degree or so, as a person does.
void carry(Bench& bench, const Pose2& way) {
  constexpr int kSteps = 60;
  const Pose2 from = bench.robot.far_end().truth().map_from_robot;
  for (int k = 1; k <= kSteps; ++k) {
    const double share = static_cast<double>(k) / kSteps;
    const Pose2 there = from * Pose2{way.x * share, way.y * share, way.heading * share};
    bench.robot.far_end().carry(inverse(bench.robot.far_end().truth().map_from_robot) * there);
    bench.tick(2);
  }
}

void reset(Bench& bench) {
  CHECK(bench.robot.desk().obey("reset") == "reset\n");
  for (int k = 0; k < 300 && has(bench.last().verdict.reasons, Reason::kLatched); ++k) bench.tick();
}

enum class Rest { kArmed, kReached, kStopped, kEmergency };

/// A drive of some seconds, which shows the robot its surroundings, and then rest.
void come_to(Rest rest, Bench& bench) {
  bench.tick(10);
  if (rest == Rest::kArmed) return bench.tick(100);
  REQUIRE(bench.robot.desk().obey("goto 4.2 6.0") == "going\n");
  bench.tick(rest == Rest::kReached ? 700 : 250);
  if (rest != Rest::kReached)
    REQUIRE(bench.robot.desk().obey(rest == Rest::kStopped ? "stop" : "stop now") == "stopping\n");
  bench.tick(150);
}

}  // namespace

TEST_CASE("a robot that is carried at rest is in doubt until its place is found again", "[carried]") {
  constexpr Pose2 kWays[] = {{1.0, 0.0, 0.0}, {-0.4, 2.0, 0.0}, {-1.2, 2.6, 0.5}, {0.0, 0.0, 1.0}, {0.6, 0.4, -2.5}};
  int found = 0, tried = 0;
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19", "two_scanners"}) {
    for (const Pose2& way : kWays) {
      const auto rest = static_cast<Rest>(tried % 4);
      CAPTURE(robot, tried % 4, way.x, way.y, way.heading);
      Bench bench(robot);
      come_to(rest, bench);
      REQUIRE_FALSE(doubtful(bench));
      REQUIRE(off_m(bench) < 0.1);
      carry(bench, way);
      bench.tick(25);
      CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
      bench.tick(500);
      ++tried;
      if (doubtful(bench)) {
        CHECK(bench.robot.desk().obey("reset").starts_with("refused: nobody knows where the robot is"));
        continue;
      }
      ++found;
      CHECK(off_m(bench) < 0.08);
      CHECK(off_rad(bench) < 0.04);
      reset(bench);
      REQUIRE(bench.robot.desk().obey("goto 4.2 6.0") == "going\n");
      for (int k = 0; k < 1500 && bench.last().input.has_goal; ++k) bench.tick();
      CHECK(distance(bench.robot.far_end().truth().map_from_robot.position(), {4.2, 6.0}) < 0.4);
    }
  }
  WARN("found again: " << found << " of " << tried);
  CHECK(found > tried / 2);
}

TEST_CASE("a person's word on where the robot is is held against the map") {
  Bench bench("robot");
  come_to(Rest::kStopped, bench);
  const Pose2 there = bench.robot.far_end().truth().map_from_robot;
  const auto here = [&](const Pose2& off, const char* force = "") {
    char words[120];
    std::snprintf(words, sizeof words, "here %.3f %.3f %.3f%s", there.x + off.x, there.y + off.y,
                  wrap_angle(there.heading + off.heading), force);
    return tests::say(bench, words);
  };
  for (const Pose2& off : {Pose2{3.0, 0.0, 0.0}, Pose2{-1.0, 0.5, 0.0}, Pose2{0.0, 0.0, 3.1}, Pose2{0.0, 0.0, -0.8}}) {
    CAPTURE(off.x, off.y, off.heading);
    const std::string answer = here(off);
    CHECK(answer.starts_with("refused: the scan "));
    CHECK(answer.find("here --force") != std::string::npos);
    CHECK(off_m(bench) < 0.1);
  }
  for (const Pose2& off : {Pose2{0.2, -0.2, 0.0}, Pose2{0.0, 0.3, 0.2}, Pose2{-0.1, 0.0, -0.2}}) {
    CAPTURE(off.x, off.y, off.heading);
    CHECK(here(off) == "there\n");
    bench.tick(50);
    CHECK(off_m(bench) < 0.05);
    CHECK(off_rad(bench) < 0.02);
  }
  CHECK(here({3.0, 0.0, 0.0}, " --force") == "there\n");
  bench.tick(10);
  CHECK(off_m(bench) > 2.0);
}

TEST_CASE("a place of which nothing is known is refused while the scan fits where the robot is believed") {
  Bench bench("robot");
  bench.tick(60);
  CHECK(tests::say(bench, "here 500 300 1.0").starts_with("refused: the scan fits much better at 2.0"));
}

TEST_CASE("a robot that stands among people is not in doubt", "[carried]") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19", "two_scanners"}) {
    CAPTURE(robot);
    Bench bench(robot);
    come_to(Rest::kReached, bench);
    bench.tick(3000);
    CHECK_FALSE(doubtful(bench));
  }
}
