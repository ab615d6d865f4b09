#include "firmware/safety/stop_zone.h"

#include <cmath>

#include "tests/safety/scans.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// A scan of 1801 beams over 360 degrees that sees single points only.
LaserScan scan_of(std::initializer_list<Vec2> points) {
  LaserScan scan = tests::scan_of(
      {.robot_from_laser = {}, .fov_rad = 2.0 * kPi, .beams = 1801, .range_min_m = 0.02, .range_max_m = 20.0},
      INFINITY);
  for (const Vec2 p : points) {
    const auto beam = static_cast<std::size_t>((jaywalk::atan2(p.y, p.x) + kPi) / (2 * kPi) * 1800.0 + 0.5);
    scan.range_m[beam] = static_cast<float>(norm(p));
  }
  return scan;
}

// A box of 1 m x 0.6 m about its axle; margin 0.1 m.
const StopZone kZone({.footprint = {.front_m = 0.5, .rear_m = 0.5, .half_width_m = 0.3},
                      .robot_from_laser = {},
                      .margin_m = 0.1,
                      .brake_mps2 = 1.5,
                      .look_ahead_m = 2.0});
constexpr double kStep_m = 0.04;  // what the gap is rounded down by

}  // namespace

TEST_CASE("a point 2 m ahead leaves 1.4 m: its distance less half a length and the margin") {
  const double gap = kZone.gap_m(scan_of({{2.0, 0.0}}), {0.5, 0.0});
  CHECK(gap <= 1.4 + 1e-6);
  CHECK(gap >= 1.4 - kStep_m - 1e-6);
}

TEST_CASE("a point counts where the body sweeps over it within reach, on a curve and by a corner on the spot too") {
  const auto counts = [](Vec2 p, const Twist2& twist) { return std::isfinite(kZone.gap_m(scan_of({p}), twist)); };
  CHECK_FALSE(counts({2.0, 0.45}, {0.5, 0.0}));  // beside the way
  CHECK_FALSE(counts({-1.0, 0.0}, {0.5, 0.0}));
  CHECK_FALSE(counts({5.0, 0.0}, {0.5, 0.0}));
  // Circle of radius 1 m to the left about (0, 1): (0.8, 0.6) is 0.89 m from there, straight ahead 0.6 m aside.
  CHECK_FALSE(counts({0.8, 0.6}, {0.5, 0.0}));
  CHECK(counts({0.8, 0.6}, {0.5, 0.5}));
  // The corner is 0.583 m from the axle: a point at 0.6 m abeam is swept, one at 0.75 m is not.
  CHECK(counts({0.0, 0.6}, {0.0, 1.0}));
  CHECK_FALSE(counts({0.0, 0.75}, {0.0, 1.0}));
}

TEST_CASE("it may leave what it faces but not press on") {
  const LaserScan scan = scan_of({{0.55, 0.0}});  // 5 cm ahead: inside the margin
  CHECK(kZone.gap_m(scan, {0.3, 0.0}) == 0.0);
  CHECK(std::isinf(kZone.gap_m(scan, {-0.3, 0.0})));
}

TEST_CASE("stopping from 1.4 m/s with 1.5 m/s2 after 0.12 s takes 0.82 m, and back") {
  // v t + v^2 / 2b = 0.168 + 0.6533 = 0.8213 m (the example of the makers' guide, less its 0.25 m of margin).
  CHECK(kZone.speed_to_stop_within(0.82133, 0.12) == Approx(1.4).epsilon(1e-4));
  CHECK(kZone.stopping_distance_m(1.4, 0.12) == Approx(0.82133).epsilon(1e-4));
  CHECK(kZone.speed_to_stop_within(0.0, 0.12) == 0.0);
  CHECK(kZone.speed_to_stop_within(-1.0, 0.12) == 0.0);
}

TEST_CASE("a cylinder of 70 mm is seen wherever it stands in the way") {
  for (double aside = -0.38; aside <= 0.381; aside += 0.02) {
    REQUIRE(kZone.gap_m(scan_of({{1.5, aside}}), {0.5, 0.0}) < 1.0);
  }
}

TEST_CASE("the slower the outline, the less is kept free: 10 cm from 0.4 m/s on, 4 cm at rest, 7 cm half-way") {
  CHECK(kZone.margin_at(0.4) == Approx(0.1));
  CHECK(kZone.margin_at(1.5) == Approx(0.1));
  CHECK(kZone.margin_at(0.0) == Approx(0.04));
  CHECK(kZone.margin_at(0.2) == Approx(0.07));
  // 7 cm beside the box, ahead of its front: met at 0.5 m/s, passed at 0.1 m/s (4 + 6/4 = 5.5 cm).
  CHECK(std::isfinite(kZone.gap_m(scan_of({{1.0, 0.37}}), {0.5, 0.0})));
  CHECK(std::isinf(kZone.gap_m(scan_of({{1.0, 0.37}}), {0.1, 0.0})));
}
