#include <cmath>
#include <limits>

#include "hal/sim/sensors.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

/// A beam every degree from -90 to 90, nothing lost, no noise.
LaserModel plain() {
  return {.robot_from_laser = {},
          .fov_rad = kPi,
          .beams = 181,
          .rate_hz = 10.0,
          .range_min_m = 0.05,
          .range_max_m = 25.0,
          .noise_m = 0.0,
          .drop_out = 0.0};
}

/// A scan in the room, from 2 m beside its right wall.
LaserScan seen_by(const LaserModel& model, const Pose2& pose = {4.0, 2.0, 0.0}, std::span<const Disc> movers = {}) {
  LaserScan scan;
  LaserSim(model, 1).sweep(room(), movers, pose, time_from_seconds(2.0), scan);
  return scan;
}

}  // namespace

TEST_CASE("beams run from right to left: 2 m to the right wall, 6 m ahead, 8 m to the left") {
  const LaserScan scan = seen_by(plain());
  CHECK(scan.beam_count == 181);
  CHECK(scan.stamp == time_from_seconds(2.0));
  CHECK(scan.range_m[0] == Approx(2.0));
  CHECK(scan.range_m[90] == Approx(6.0));
  CHECK(scan.range_m[180] == Approx(8.0));
  CHECK(scan.angle_rad(0) == Approx(-kPi / 2));
  CHECK(scan.angle_rad(180) == Approx(kPi / 2).margin(1e-5));
  CHECK(seen_by(plain(), {4.0, 2.0, kPi / 2}).range_m[90] == Approx(8.0));  // it looks up
}

TEST_CASE("a scanner that turns measures each beam from where the robot is then, and stamps the scan when it began") {
  LaserModel model = plain();  // 180 degrees at 10 Hz: 50 ms
  model.turns = true;
  LaserSim laser(model, 1);
  const Walls walls = room();
  LaserScan scan;
  CHECK(laser.turn_takes() == std::chrono::milliseconds(50));
  laser.begin_turn(time_from_seconds(2.0));
  const auto at = [&](double seconds) {
    return laser.turn(walls, {}, {4.0 + seconds, 2.0, 0.0}, time_from_seconds(2.0 + seconds), scan);  // at 1 m/s
  };
  CHECK_FALSE(at(0.0));
  for (int ms = 2; ms < 50; ms += 2) CHECK_FALSE(at(0.001 * ms));
  CHECK(at(0.05));
  CHECK(scan.stamp == time_from_seconds(2.0));
  CHECK(scan.sweep == std::chrono::milliseconds(50));
  CHECK(scan.range_m[0] == Approx(2.0));
  CHECK(scan.range_m[90] == Approx(6.0 - 0.026).margin(0.002));  // beam 90 is due after 25 ms
  CHECK_FALSE(at(0.052));
}

TEST_CASE("a laser 0.7 m ahead of the axle and turned left measures from there") {
  LaserModel model = plain();
  model.robot_from_laser = {0.7, 0.0, kPi / 2};
  const LaserScan scan = seen_by(model);
  CHECK(scan.range_m[90] == Approx(8.0));  // left of the robot
  CHECK(scan.range_m[0] == Approx(5.3));   // its front: 10 - 4.7
}

TEST_CASE("a mover hides the wall behind it: 0.27 m radius, 3 m ahead, seen at 2.73 m") {
  const Disc mover{{7.0, 2.0}, 0.27};
  const LaserScan scan = seen_by(plain(), {4.0, 2.0, 0.0}, {&mover, 1});
  CHECK(scan.range_m[90] == Approx(2.73));
  CHECK(scan.range_m[84] == Approx(6.0 / std::cos(6.0 * kPi / 180)));  // asin(0.27 / 3) is 5.16 degrees
  CHECK(scan.range_m[85] < 3.0);
}

TEST_CASE("walls beyond the range leave a beam free, and those too near leave it unknown") {
  LaserModel model = plain();
  model.range_max_m = 5.0;
  model.range_min_m = 2.5;
  const LaserScan scan = seen_by(model);
  CHECK(scan.range_m[90] == std::numeric_limits<float>::infinity());
  CHECK(scan.range_m[0] == 0.0F);
  CHECK(scan.state(90) == BeamState::kFree);
  CHECK(scan.state(0) == BeamState::kUnknown);
  CHECK(scan.state(45) == BeamState::kHit);  // 2 root 2 m
}

TEST_CASE("noise of 2 cm is 2 cm without bias, and 20 percent drop-out loses 20 percent") {
  LaserModel noisy = plain();
  noisy.noise_m = 0.02;
  noisy.drop_out = 0.2;
  LaserSim laser(noisy, 1);
  const Walls walls = room();
  const Pose2 pose{4.0, 2.0, 0.3};
  const LaserScan truth = seen_by(plain(), pose);
  LaserScan scan;
  double sum = 0.0, squares = 0.0;
  int seen = 0;
  constexpr int kSweeps = 200;
  for (int k = 0; k < kSweeps; ++k) {
    laser.sweep(walls, {}, pose, time_from_seconds(2.0), scan);
    for (std::size_t b = 0; b < 181; ++b) {
      if (!scan.is_hit(b)) {
        REQUIRE(scan.state(b) == BeamState::kUnknown);  // lost
        continue;
      }
      const double error = static_cast<double>(scan.range_m[b]) - static_cast<double>(truth.range_m[b]);
      sum += error;
      squares += error * error;
      ++seen;
    }
  }
  CHECK(seen / (181.0 * kSweeps) == Approx(0.8).margin(0.0064));     // three times sqrt(0.16 / 36200) = 0.0021
  CHECK(sum / seen == Approx(0.0).margin(0.0004));                   // three times 0.02 / sqrt(28960) = 0.00012
  CHECK(std::sqrt(squares / seen) == Approx(0.02).epsilon(0.0125));  // three times 1 / sqrt(57920)
}
