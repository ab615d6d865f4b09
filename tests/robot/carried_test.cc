// A robot at rest that is lifted, carried and turned by hand: told, nothing moves, and it stays in doubt until a person
// says where it is, whose word is held against the map.
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

[[nodiscard]] std::string here(const Pose2& place) {
  char words[120];
  std::snprintf(words, sizeof words, "here %.3f %.3f %.3f", place.x, place.y, wrap_angle(place.heading));
  return words;
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

TEST_CASE("a robot that is carried at rest is in doubt until a person says where it is", "[carried]") {
  constexpr Pose2 kWays[] = {{1.0, 0.0, 0.0}, {-0.4, 2.0, 0.0}, {0.9, 1.8, 0.5}, {0.0, 0.0, 1.0}, {0.6, 0.4, -2.5}};
  int tried = 0, carried = 0;
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    for (const Pose2& way : kWays) {
      const auto rest = static_cast<Rest>(tried++ % 4);
      CAPTURE(robot, static_cast<int>(rest), way.x, way.y, way.heading);
      Bench bench(robot);
      come_to(rest, bench);
      REQUIRE_FALSE(doubtful(bench));
      REQUIRE(off_m(bench) < 0.1);
      carry(bench, way);
      const sim::Truth& truth = bench.robot.far_end().truth();
      if (truth.contacts > 0 || truth.clearance_m < 0.3) continue;  // nobody puts it into a wall
      ++carried;
      bench.tick(25);
      CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
      bench.tick(100);
      REQUIRE(doubtful(bench));
      CHECK(bench.robot.desk().obey("reset").starts_with("refused: nobody knows where the robot is"));
      const Pose2 there = bench.robot.far_end().truth().map_from_robot;
      CHECK(tests::say(bench, here(there * Pose2{0.1, -0.1, 0.05})) == "there\n");
      bench.tick(20);
      CHECK_FALSE(doubtful(bench));
      CHECK(off_m(bench) < 0.11);  // a person's eye
      CHECK(off_rad(bench) < 0.04);
      reset(bench);
      if (std::string_view(robot) == "vesc_ld19") continue;  // walls beyond 12 m are unwatched: it stands
      REQUIRE(bench.robot.desk().obey("goto 4.2 6.0") == "going\n");
      bench.tick(5);
      for (int k = 0; k < 1500 && bench.last().input.has_goal; ++k) bench.tick();
      CHECK(distance(bench.robot.far_end().truth().map_from_robot.position(), {4.2, 6.0}) < 0.4);
    }
  }
  CHECK(carried >= 10);
}

TEST_CASE("a person's word on where the robot is is held against the map") {
  Bench bench("robot");
  come_to(Rest::kStopped, bench);
  const Pose2 there = bench.robot.far_end().truth().map_from_robot;
  const auto say_off = [&](const Pose2& off, const char* force = "") {
    return tests::say(bench, here({there.x + off.x, there.y + off.y, there.heading + off.heading}) + force);
  };
  for (const Pose2& off : {Pose2{3.0, 0.0, 0.0}, Pose2{-1.0, 0.5, 0.0}, Pose2{0.0, 0.0, 3.1}, Pose2{0.0, 0.0, -0.8}}) {
    CAPTURE(off.x, off.y, off.heading);
    const std::string answer = say_off(off);
    CHECK(answer.starts_with("refused: the scan "));
    CHECK(answer.find("here --force") != std::string::npos);
    CHECK(off_m(bench) < 0.1);
  }
  for (const Pose2& off : {Pose2{0.2, -0.2, 0.0}, Pose2{0.0, 0.3, 0.2}, Pose2{-0.1, 0.0, -0.2}}) {
    CAPTURE(off.x, off.y, off.heading);
    CHECK(say_off(off) == "there\n");
    bench.tick(50);
    CHECK(off_m(bench) < 0.05);
    CHECK(off_rad(bench) < 0.02);
  }
  CHECK(say_off({3.0, 0.0, 0.0}, " --force") == "there\n");
  bench.tick(10);
  CHECK(off_m(bench) > 2.0);
}

TEST_CASE("a place of which nothing is known is refused while the scan fits where the robot is believed") {
  Bench bench("robot");
  bench.tick(60);
  CHECK(tests::say(bench, "here 500 300 1.0").starts_with("refused: the scan fits much better at 2.0"));
}

TEST_CASE("a robot that stands among people is not in doubt", "[carried]") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    CAPTURE(robot);
    Bench bench(robot);
    come_to(Rest::kReached, bench);
    bench.tick(3000);
    CHECK_FALSE(doubtful(bench));
  }
}
