#include "firmware/safety/motion_model.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "tests/safety/trial_room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using trials::Walker;
using trials::Wall;

namespace {

/// How a robot's wheels and scanner are connected: what the ground gets of each wheel's turning.
struct Wiring {
  double left = 1.0, right = 1.0;
  bool swapped = false, mirrored = false;
};

/// A robot among walls and people, its wheels read every 10 ms, its scanner with 10 mm of noise.
struct Bench {
  std::vector<Wall> walls{};
  std::vector<Walker> people{};
  Wiring wiring{};
  RobotModel model = p3dx();
  Pose2 pose{};
  double now_s = 0.0;
  MotionModel motion{model};
  double mount_turned = 0.0, mount_ahead_m = 0.0;
  bool frozen = false;  ///< that was said last
  std::function<void(LaserScan&)> spoil = [](LaserScan&) {};
  LaserScan scan{};
  WheelState wheels{};
  std::mt19937 random{7};
  std::normal_distribution<double> noise{0.0, 0.01};

  void look() {
    const LaserModel& laser = model.laser;
    scan.stamp = time_from_seconds(now_s);
    ++scan.sequence;
    tests::lay_beams(scan, laser);
    Pose2 eye = pose * Pose2{mount_ahead_m, 0.0, 0.0} * laser.robot_from_laser;
    eye.heading += mount_turned;
    for (std::size_t k = 0; k < scan.beam_count; ++k) {
      const double angle = wiring.mirrored ? -scan.angle_rad(k) : scan.angle_rad(k);
      const double metres = trials::range(walls, people, eye.position(), direction(eye.heading + angle));
      scan.range_m[k] = static_cast<float>(metres + noise(random));
    }
    spoil(scan);
  }
  /// Ten milliseconds at these speeds (m/s) of the wheels, as they feel them.
  bool step(double left_mps, double right_mps) {
    now_s += 0.01;
    const double radius = model.drive.wheel_radius_m;
    wheels.left_rad += 0.01 * left_mps / radius;
    wheels.right_rad += 0.01 * right_mps / radius;
    wheels.stamp = time_from_seconds(now_s);
    ++wheels.sequence;
    double left = wiring.left * left_mps, right = wiring.right * right_mps;
    if (wiring.swapped) std::swap(left, right);
    const double turn = 0.01 * (right - left) / model.drive.track_width_m;
    const Vec2 way = direction(pose.heading + 0.5 * turn) * (0.005 * (left + right));
    pose = {pose.x + way.x, pose.y + way.y, wrap_angle(pose.heading + turn)};
    for (Walker& walker : people) walker.centre = walker.centre + walker.velocity * 0.01;
    if (std::fmod(now_s + 1e-6, 1.0 / model.laser.rate_hz) < 0.01) look();
    const Reason reasons = motion.judge(scan, wheels, {}, time_from_seconds(now_s));
    frozen = has(reasons, Reason::kScanFrozen);
    return has(reasons, Reason::kMotionMismatch);
  }
  /// Seconds until a contradiction; infinity where there is none within `limit_s`.
  double told_after(double limit_s, double left_mps, double right_mps) {
    for (double t = 0.0; t < limit_s; t += 0.01) {
      if (step(left_mps, right_mps)) return t;
    }
    return std::numeric_limits<double>::infinity();
  }
};

std::vector<Wall> room() {
  return {{{-3.0, -2.0}, {4.0, -2.0}}, {{4.0, -2.0}, {4.0, 3.0}},  {{4.0, 3.0}, {-3.0, 3.0}},
          {{-3.0, 3.0}, {-3.0, -2.0}}, {{2.5, -2.0}, {2.5, -1.2}}, {{-1.0, 3.0}, {0.0, 2.2}}};
}
std::vector<Wall> endless_corridor() { return {{{-200.0, -1.0}, {200.0, -1.0}}, {{-200.0, 1.0}, {200.0, 1.0}}}; }

/// Two walls of cells of 0.1 m, in steps of 1 cm or none, one cell in eight set back by 0.1 m.
std::vector<Wall> stepped_corridor(std::uint32_t seed) {
  std::mt19937 random{seed};
  std::vector<Wall> walls;
  for (const double side : {-1.0, 1.0}) {
    const double slant = 0.002 * static_cast<double>(random() % 101);
    double before = side;
    for (int cell = -40; cell < 400; ++cell) {
      const double x = 0.1 * cell, out = random() % 8 == 0 ? 0.1 : 0.0;
      const double y = side + 0.01 * std::floor(slant * cell) + side * out;
      walls.push_back({{x, before}, {x, y}});
      walls.push_back({{x, y}, {x + 0.1, y}});
      before = y;
    }
  }
  return walls;
}

const std::vector<std::pair<double, double>> kMotions{{0.3, 0.3}, {-0.3, -0.3}, {0.25, 0.35},
                                                      {0.6, 0.5}, {-0.1, 0.1},  {0.05, 0.25}};

}  // namespace

TEST_CASE("what the scans show is what sound wheels felt, straight, in bends and on the spot") {
  const auto [left, right] = GENERATE(from_range(kMotions));
  Bench bench{.walls = room()};
  CHECK(std::isinf(bench.told_after(2.0, left, right)));
}

TEST_CASE("a wheel reversed with its encoder is told within half a second of driving, and so are both") {
  const auto [left, right] = GENERATE(std::pair{-1.0, 1.0}, std::pair{1.0, -1.0}, std::pair{-1.0, -1.0});
  const double speed = GENERATE(0.2, 0.3, 0.6);
  Bench bench{.walls = room(), .wiring = {.left = left, .right = right}};
  CHECK(bench.told_after(1.0, speed, speed) < 0.5);
}

TEST_CASE("swapped wheels and a mirrored scanner are told within half a second of turning, not before") {
  const Wiring wiring = GENERATE(Wiring{.swapped = true}, Wiring{.mirrored = true});
  Bench straight{.walls = room(), .wiring = wiring};
  CHECK(std::isinf(straight.told_after(2.0, 0.3, 0.3)));
  for (const double rim : {0.05, 0.15, 0.3}) {  // 0.3 rad/s to 1.8 rad/s
    Bench turning{.walls = room(), .wiring = wiring};
    CHECK(turning.told_after(1.0, -rim, rim) < 0.5);
  }
  int in_time = 0;
  for (std::uint32_t draw = 1; draw <= 20; ++draw) {  // of the scanner's noise
    Bench bending{.walls = room(), .wiring = wiring};
    bending.random.seed(draw);
    in_time += bending.told_after(1.0, 0.25, 0.35) < 0.5 ? 1 : 0;
  }
  CHECK(in_time >= 18);
}

TEST_CASE("wheels that spin while the robot stands are told within half a second, half of their grip is slip") {
  for (const auto& [left, right] : {std::pair{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}) {
    Bench spinning{.walls = room(), .wiring = {.left = left, .right = right}};
    CHECK(spinning.told_after(1.0, 0.3, 0.3) < 0.5);
  }
  for (const double grip : {0.95, 0.8, 0.5, 0.4}) {
    Bench slipping{.walls = room(), .wiring = {.left = grip}};
    CHECK(std::isinf(slipping.told_after(2.0, 0.3, 0.3)));
    Bench both{.walls = room(), .wiring = {.left = grip, .right = grip}};
    CHECK(std::isinf(both.told_after(2.0, 0.3, 0.3)));
  }
}

TEST_CASE("a scanner before the axle and turned on its mount is reckoned with") {
  RobotModel model = p3dx();
  model.laser.robot_from_laser = {0.7, 0.1, 0.5 * kPi};
  for (const auto& [left, right] : kMotions) {
    Bench bench{.walls = room(), .model = model};
    CHECK(std::isinf(bench.told_after(2.0, left, right)));
  }
  Bench reversed{.walls = room(), .wiring = {.left = -1.0, .right = -1.0}, .model = model};
  CHECK(reversed.told_after(1.0, 0.3, 0.3) < 0.5);
}

TEST_CASE("five scans a second are enough") {
  RobotModel model = p3dx();
  model.laser.rate_hz = 5.0;
  Bench sound{.walls = room(), .model = model};
  CHECK(std::isinf(sound.told_after(2.0, 0.3, 0.35)));
  Bench reversed{.walls = room(), .wiring = {.left = -1.0}, .model = model};
  CHECK(reversed.told_after(2.0, 0.3, 0.3) < 0.65);  // half a second and the scan that it waits for
}

TEST_CASE("where scans cannot tell there is no fault: along an endless corridor, and on open ground") {
  Bench corridor{.walls = endless_corridor(), .wiring = {.left = -1.0, .right = -1.0}};
  CHECK(std::isinf(corridor.told_after(3.0, 0.3, 0.3)));
  Bench open{.wiring = {.left = -1.0, .right = -1.0}};
  CHECK(std::isinf(open.told_after(3.0, 0.3, 0.3)));
}

TEST_CASE("walls whose steps look alike from cell to cell are no blind sector") {
  for (const std::uint32_t seed : {1U, 8U, 15U}) {  // of 40, some on which sums by sector, added up, told one
    CAPTURE(seed);
    Bench bench{.walls = stepped_corridor(seed)};
    bench.random.seed(seed);
    CHECK(std::isinf(bench.told_after(50.0, 0.6, 0.6)));
  }
}

TEST_CASE("people who walk along with a sound robot are no fault, in a room, a corridor or on open ground") {
  const std::vector<Walker> company{{{0.2, 0.8}, {0.6, 0.0}}, {{0.3, -0.8}, {0.6, 0.0}}, {{1.5, 0.2}, {0.6, 0.0}}};
  const std::vector<Wall> walls = GENERATE(room(), endless_corridor(), std::vector<Wall>{});
  Bench bench{.walls = walls, .people = company};
  CHECK(std::isinf(bench.told_after(3.0, 0.6, 0.6)));
}

TEST_CASE("the same scan again and again is frozen once a wheel has rolled 0.1 m, in a bare corridor, too") {
  const std::vector<Wall> walls = GENERATE(room(), endless_corridor());
  Bench bench{.walls = walls};
  REQUIRE(std::isinf(bench.told_after(1.0, 0.3, 0.3)));
  CHECK_FALSE(bench.frozen);
  bench.spoil = [first = bench.scan](LaserScan& scan) { scan.range_m = first.range_m; };
  double frozen_s = 0.0;
  for (; frozen_s < 1.0 && !bench.frozen; frozen_s += 0.01) bench.step(0.3, 0.3);
  CHECK(frozen_s > 0.3);
  CHECK(frozen_s < 0.5);
  for (int k = 0; k < 50; ++k) bench.step(0.0, 0.0);
  CHECK(bench.frozen);  // though it stands
  bench.spoil = [](LaserScan&) {};
  for (int k = 0; k < 20; ++k) bench.step(0.0, 0.0);
  CHECK_FALSE(bench.frozen);
}

TEST_CASE("a robot that stands may see the same scan for ever, and so may one where nothing is in reach") {
  Bench standing{.walls = room()};
  REQUIRE(std::isinf(standing.told_after(1.0, 0.0, 0.0)));
  standing.spoil = [first = standing.scan](LaserScan& scan) { scan.range_m = first.range_m; };
  CHECK(std::isinf(standing.told_after(5.0, 0.0, 0.0)));
  CHECK_FALSE(standing.frozen);
  Bench open;
  CHECK(std::isinf(open.told_after(3.0, 0.3, 0.3)));
  CHECK_FALSE(open.frozen);
}

TEST_CASE("a scan that is frozen but for one beam or for noise, or over 80 degrees ahead, is told in half a second") {
  const double noise_m = GENERATE(0.0, 0.004);
  const double half = GENERATE(4.0, 40.0 / 180.0 * kPi);
  const double speed = GENERATE(0.3, 0.6);
  CAPTURE(noise_m, half, speed);
  Bench bench{.walls = room()};
  REQUIRE(std::isinf(bench.told_after(1.0, speed, speed)));
  std::mt19937 random{3};
  std::normal_distribution<double> noise{0.0, noise_m};
  bench.spoil = [&, first = bench.scan](LaserScan& scan) {
    for (std::size_t k = 0; k < scan.beam_count; ++k) {
      if (std::fabs(scan.angle_rad(k)) > half) continue;
      scan.range_m[k] = first.range_m[k] + static_cast<float>(noise_m > 0.0 ? noise(random) : 0.0);
    }
    scan.range_m[scan.beam_count / 2] += 0.001F * static_cast<float>(scan.sequence % 7);
  };
  double told_s = 0.0;
  for (; told_s < 1.0 && !bench.step(speed, speed) && !bench.frozen;) told_s += 0.01;
  CHECK(told_s < 0.5);
}

TEST_CASE("a mount turned by 15 degrees, wheels that go 1.3 times as far and ranges 1.3 times too long are told") {
  for (const double turned : {15.0, -15.0, 60.0, 150.0}) {
    Bench bench{.walls = room()};
    REQUIRE(std::isinf(bench.told_after(1.0, 0.4, 0.4)));
    bench.mount_turned = turned / 180.0 * kPi;
    CHECK(bench.told_after(1.0, 0.4, 0.4) < 0.6);
  }
  for (const double gain : {1.3, 2.0}) {
    Bench wheels{.walls = room(), .wiring = {.left = gain, .right = gain}};
    CHECK(wheels.told_after(2.0, 0.4, 0.4) < 0.6);
    Bench ranges{.walls = room()};
    ranges.spoil = [gain](LaserScan& scan) {
      for (float& range : scan.range_m) range *= static_cast<float>(gain);
    };
    CHECK(ranges.told_after(2.0, 0.4, 0.4) < 0.9);
  }
}

TEST_CASE("a scanner 0.12 m off its place ahead of the axle is told by a turn on the spot, one 3 cm off is not") {
  for (const double ahead_m : {0.12, -0.12, 0.25}) {
    Bench bench{.walls = room(), .mount_ahead_m = ahead_m};
    CHECK(bench.told_after(8.0, -0.08, 0.08) < 3.0);  // half a radian a second
  }
  for (const double ahead_m : {0.03, -0.03}) {
    Bench bench{.walls = room(), .mount_ahead_m = ahead_m};
    CHECK(std::isinf(bench.told_after(20.0, -0.08, 0.08)));
  }
}

TEST_CASE("wheels that go half as far over metres are told: slip does not last") {
  Bench bench{.walls = room(), .wiring = {.left = 0.5, .right = 0.5}};
  const double told_s = bench.told_after(12.0, 0.4, 0.4);
  CHECK(told_s > 2.0);
  CHECK(told_s < 10.0);
}

TEST_CASE("scans that hit nothing and wheels without a number say nothing of motion") {
  Bench bench{.walls = room()};
  REQUIRE(std::isinf(bench.told_after(1.0, 0.3, 0.3)));
  LaserScan nothing = bench.scan;
  nothing.range_m.fill(std::numeric_limits<float>::infinity());
  WheelState broken = bench.wheels;
  broken.left_rad = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 100; ++k) {
    ++nothing.sequence;
    ++broken.sequence;
    const Reason reasons = bench.motion.judge(nothing, broken, {}, time_from_seconds(bench.now_s));
    CHECK_FALSE(has(reasons, Reason::kMotionMismatch | Reason::kScanFrozen));
  }
}

TEST_CASE("scans of no sound shape are passed over") {
  const std::uint32_t beams = GENERATE(0U, 1U, 5000U);
  Bench bench{.walls = room()};
  REQUIRE(std::isinf(bench.told_after(1.0, 0.3, 0.3)));
  LaserScan bad = bench.scan;
  bad.beam_count = beams;
  ++bad.sequence;
  const Reason reasons = bench.motion.judge(bad, bench.wheels, {}, time_from_seconds(bench.now_s));
  CHECK_FALSE(has(reasons, Reason::kMotionMismatch | Reason::kScanFrozen));
}
