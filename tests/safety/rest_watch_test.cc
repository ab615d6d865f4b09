// A robot at rest that is lifted, pushed aside or turned by hand, in rooms with people, and one that nobody touches.
#include <optional>
#include <random>

#include "firmware/safety/felt_motion.h"
#include "tests/safety/trial_room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using trials::Engine;
using trials::uniform;
using Says = RestWatch::Says;

namespace {

/// It stands in the middle of a room with furniture.
struct Standing {
  explicit Standing(std::uint64_t seed, int people)
      : engine(seed), room(engine, people), watch(model), noise_m(uniform(engine, 0.003, 0.02)) {
    pose.heading = uniform(engine, -kPi, kPi);
    constexpr double kFov_deg[3] = {180.0, 270.0, 359.0};
    const int kind = static_cast<int>(uniform(engine, 0.0, 3.0));
    model.laser.fov_rad = kFov_deg[kind] / 180.0 * kPi;
    model.laser.beams = static_cast<std::uint32_t>(kFov_deg[kind] * uniform(engine, 1.0, 3.0)) + 1;
    model.laser.range_max_m = 25.0;
    watch = RestWatch(model);
    tick(1.0);
  }
  /// Lives for `time_s` with a scan every 80 ms; returns the worst answer.
  Says tick(double time_s) {
    Says worst = Says::kNothing;
    for (const double end_s = now_s + time_s; now_s < end_s;) {
      now_s += 0.02;
      room.move(0.02, pose.position());
      read_wheels();
      if (now_s >= next_scan_s) look();
      const Says says = watch.judge(scan, wheels);
      worst = std::max(worst, says);
      if (says == Says::kMoved && !told_s) told_s = now_s;
    }
    return worst;
  }
  /// Evenly, in that time; scans go on.
  void carry(const Pose2& way, double time_s) {
    const Pose2 from = pose;
    for (int k = 1; k <= 50; ++k) {
      pose = from * Pose2{way.x * k / 50.0, way.y * k / 50.0, way.heading * k / 50.0};
      tick(time_s / 50.0);
    }
  }
  void read_wheels() {
    if (silent) return;
    ++wheels.sequence;
    wheels.stamp = time_from_seconds(now_s + 0.001);
  }
  void look() {
    next_scan_s = now_s + 0.08;
    if (covered) return;
    Pose2 eye = pose * model.laser.robot_from_laser;
    eye.heading += shakes_rad * std::sin(40.0 * now_s);
    trials::sweep(room, eye, model.laser, scan);
    ++scan.sequence;
    scan.stamp = time_from_seconds(now_s);
    for (std::size_t k = 0; k < scan.beam_count; ++k) scan.range_m[k] += static_cast<float>(noise_m * normal(engine));
  }

  Engine engine;
  RobotModel model = p3dx();
  trials::Room room;
  RestWatch watch;
  Pose2 pose;
  double noise_m, now_s = 0.0, next_scan_s = 0.0, shakes_rad = 0.0;
  bool covered = false, silent = false;
  std::optional<double> told_s;
  LaserScan scan;
  WheelState wheels;
  std::normal_distribution<double> normal;
};

struct Carry {
  const char* name;
  Pose2 way;
};
constexpr Carry kCarries[] = {{"0.3 m", {0.3, 0.0, 0.0}},       {"0.85 m", {0.6, -0.6, 0.0}},
                              {"turned by 1 rad", {0, 0, 1}},   {"turned by -0.2 rad", {0, 0, -0.2}},
                              {"0.8 m and 2 rad", {0.8, 0, 2}}, {"0.9 m, turned back", {-0.6, 0.6, 3.1}}};

}  // namespace

TEST_CASE("a robot that is carried at rest is told of") {
  int told = 0, tried = 0;
  for (const Carry& carry : kCarries) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      for (const bool at_once : {false, true}) {
        Standing robot(seed, static_cast<int>(seed % 5));
        REQUIRE(robot.tick(2.0) < Says::kMoved);
        if (at_once) {
          robot.covered = true;
          robot.tick(0.5);
          robot.pose = robot.pose * carry.way;
          robot.covered = false;
        } else {
          robot.carry(carry.way, 2.0);
        }
        robot.tick(1.0);
        ++tried;
        told += robot.told_s ? 1 : 0;
      }
    }
  }
  INFO(told << " of " << tried);
  CHECK(told >= 0.98 * tried);  // chance explains the rest: a cramped room, a noisy scanner of 180 degrees
}

TEST_CASE("a robot that stands among people is not told to have been carried") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Standing robot(seed, 12);
    CHECK(robot.tick(60.0) < Says::kMoved);
  }
}

TEST_CASE("a scanner that shakes in its mount was not carried") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Standing robot(seed, 3);
    robot.shakes_rad = 0.02;
    CHECK(robot.tick(20.0) < Says::kMoved);
  }
}

TEST_CASE("a robot that is carried while its drives are silent, or restart, is told of when they speak") {
  const bool restarts = GENERATE(false, true);
  CAPTURE(restarts);
  Standing robot(4, 0);
  robot.silent = true;
  robot.tick(1.0);
  robot.pose = robot.pose * Pose2{1.0, 0.0, 0.0};
  CHECK(robot.tick(1.0) == Says::kNothing);
  robot.silent = false;
  if (restarts) robot.wheels = {.sequence = 0, .left_rad = 12.0};
  robot.tick(1.0);
  CHECK(robot.told_s);
}

TEST_CASE("wheels that roll begin the rest anew") {
  Standing robot(5, 0);
  robot.wheels.left_rad += 1.0;
  robot.pose = robot.pose * Pose2{0.5, 0.0, 0.4};
  CHECK(robot.tick(2.0) < Says::kDoubts);
}
