// Two scans of bare walls, matched: the errors that a motion leaves, and what the match claims to know.
#include "firmware/safety/scan_pair.h"

#include <Eigen/LU>
#include <random>
#include <vector>

#include "tests/safety/trial_room.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// An LMS200's view, a beam a degree over 180, of a wall x = `ahead_m`; with `left_m` of another, y = left_m, which
/// hides the first one from where they meet.
LaserScan walls(double ahead_m, double left_m, double noise_m, std::mt19937_64& engine) {
  std::normal_distribution<double> noise(0.0, noise_m);
  LaserScan scan = tests::scan_of(
      {.robot_from_laser = {}, .fov_rad = kPi, .beams = 181, .range_min_m = 0.05, .range_max_m = 8.0}, 0.0F);
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    const Vec2 along = direction(scan.angle_rad(beam));
    const double ahead = along.x > 1e-3 ? ahead_m / along.x : 100.0, left = along.y > 1e-3 ? left_m / along.y : 100.0;
    scan.range_m[beam] = static_cast<float>(std::min({ahead, left, 20.0}) + (noise_m > 0.0 ? noise(engine) : 0.0));
  }
  return scan;
}

/// Ready to match newer scans against this one.
ScanPair kept_of(const LaserScan& scan) {
  ScanPair pair{Pose2{}};
  REQUIRE(pair.usable(scan));
  pair.keep(scan);
  return pair;
}

/// Standard deviations of the match of two scans, the newer from 5 cm nearer to the wall ahead: ahead and aside, m.
Vec2 claimed_std_m(double left_m, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const LaserScan kept = walls(1.5, left_m, 0.01, engine), now = walls(1.45, left_m, 0.01, engine);
  const Eigen::Matrix3d covariance = kept_of(kept).fit(now, {}).information.inverse();
  return {std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1))};
}

constexpr double kPost_m = 0.075;  ///< radius of a post

/// Two fences of posts that touch, 4.5 m apart, one across behind the robot, and 80 single posts ahead.
std::vector<trials::Walker> posts(std::mt19937_64& engine) {
  std::vector<trials::Walker> all;
  const auto put = [&all](Vec2 place) { all.push_back({place, {}, kPost_m}); };
  for (double x = -2.9; x < 6.5; x += 2.0 * kPost_m) put({x, -2.25}), put({x, 2.25});
  for (double y = -2.2; y < 2.2; y += 2.0 * kPost_m) put({-2.9, y});
  std::uniform_real_distribution<double> ahead(1.5, 6.5), aside(-2.0, 2.0);
  for (int k = 0; k < 80; ++k) put({ahead(engine), aside(engine)});
  return all;
}

/// View of round things over 270 degrees, a beam each third of a degree.
LaserScan among(const std::vector<trials::Walker>& things, const Pose2& laser, double noise_m,
                std::mt19937_64& engine) {
  std::normal_distribution<double> noise(0.0, noise_m);
  LaserScan scan = tests::scan_of(p3dx().laser, 0.0F);
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    const Vec2 along = direction(laser.heading + scan.angle_rad(beam));
    const double nearest = std::min(30.0, trials::range({}, things, laser.position(), along));
    scan.range_m[beam] = static_cast<float>(nearest + (noise_m > 0.0 ? noise(engine) : 0.0));
  }
  return scan;
}

}  // namespace

TEST_CASE("among posts no match is much more likely than the truth") {
  // Logarithm of the likelihoods' ratio. With straight surfaces it reached 19, and 10 contradicts the wheels: 34 of 100
  // drives among posts (bench/worlds.py posts, seeds 312 and 313) ended with a false motion_mismatch.
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 engine(seed);
    const std::vector<trials::Walker> world = posts(engine);
    const Pose2 moved{0.015, 0.0, seed % 2 == 0 ? 0.05 : -0.05};
    const LaserScan kept = among(world, {}, 0.01, engine), now = among(world, moved, 0.01, engine);
    const ScanPair pair = kept_of(kept);
    const ScanPair::Fit fit = pair.fit(now, moved);
    CHECK(fit.tells());
    const ScanPair::Errors best = pair.errors(now, fit.kept_from_now), truth = pair.errors(now, moved);
    most = std::max(most, ScanPair::without_greatest(pair.advantage(best, truth, fit.noise_m, false)));
  }
  CHECK(most < 5.0);
}

TEST_CASE("a round surface is where it was: its bend is no error") {
  // The sagitta, by hand: a circle of 0.5 m bends by 0.1 x 0.1 / (2 x 0.5) = 10 mm over 2 x 0.1 m. From its line of
  // least squares the middle is off by a third of that (measured up to 7 mm where it is seen at a slant).
  std::mt19937_64 engine(1);
  const LaserScan scan = among({{{2.0, 0.0}, {}, 0.5}}, {}, 0.0, engine);
  const ScanPair::Errors errors = kept_of(scan).errors(scan, {});
  const auto compared =
      std::count_if(errors.begin(), errors.end(), [](float e) { return !std::isnan(e) && e != 0.0F; });
  CHECK(compared > 4);
  for (const float error_m : errors)
    if (!std::isnan(error_m)) CHECK(std::fabs(error_m) < 0.001F);
}

TEST_CASE("a scan from 3 cm nearer to a wall leaves 3 cm at each point of it, wherever along the wall it was taken") {
  std::mt19937_64 engine(1);
  const LaserScan kept = walls(2.0, 100.0, 0.0, engine), now = walls(1.97, 100.0, 0.0, engine);
  const ScanPair pair = kept_of(kept);
  int compared = 0;
  for (const double aside_m : {0.0, 0.1}) {
    const ScanPair::Errors still = pair.errors(now, {0.0, aside_m, 0.0}),
                           moved = pair.errors(now, {0.03, aside_m, 0.0});
    for (std::size_t k = 15; k < 60; ++k) {  // well within the wall: of every other beam that hits, 75 in all
      if (std::isnan(still[k]) || std::isnan(moved[k])) continue;
      ++compared;
      CHECK(std::fabs(still[k]) == Approx(0.03).margin(0.001));
      CHECK(moved[k] == Approx(0.0).margin(0.001));
    }
  }
  CHECK(compared == 90);
}

TEST_CASE("a match knows nothing of the way along a bare wall, and both ways in a corner") {
  // 1 cm of noise, a hundred points: a millimetre across the wall.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const Vec2 bare = claimed_std_m(100.0, seed), corner = claimed_std_m(1.2, seed);
    CHECK(bare.x < 0.005);
    CHECK(bare.y > 0.05);  // it claimed 0.01 m: the prior of its own step, and normals that noise had turned
    CHECK(corner.x < 0.005);
    CHECK(corner.y < 0.005);
  }
}
