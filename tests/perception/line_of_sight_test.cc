#include "planner/scan/line_of_sight.h"

#include <cmath>
#include <limits>

#include "hal/types/trig.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

const Room kPost = with({{{2.0, 0.0}, 0.1}});

/// Steps along two sides of a square of 5 m at 0.5 m/s, about (2.5, 0) in the room.
Vec2 walker_after(double s) {
  const double way = 0.5 * s;
  return way < 3.0 ? Vec2{4.0, -1.5 + way} : Vec2{4.0 - (way - 3.0), 1.5};
}

struct Counted {
  int claimed = 0, within = 0;
};

/// Of a disc that walks past a laser that stands behind a post, once it has walked for a second since its last turn.
Counted followed(double radius_m) {
  SettledWatch watch;
  Counted counted;
  for (int scan = 0; scan < 150; ++scan) {
    const double s = scan / 15.0;
    Room room = with({{walker_after(s), radius_m}, {{2.0, 0.3}, 0.05}});
    watch.see(room);
    if (s < 2.0 || (s > 6.0 && s < 7.0) || watch.tracker.moving().empty()) continue;
    const Track& track = watch.tracker.moving()[0];
    const Vec2 off = track.position_in_map - walker_after(s);
    counted.claimed += 1;
    counted.within += dot(off, off) <= 5.991 * track.covariance.pp ? 1 : 0;  // chi-squared, two degrees, 95 %
  }
  return counted;
}

}  // namespace

TEST_CASE("a place is seen taken, passed over where all beams near it go on, or not at all") {
  const LaserScan scan = scan_of(kPost, {}, 1);
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({1.9, 0.0}, 0.05) == Sight::kThere);    // the near side of the post
  CHECK(sight.at({1.5, 0.0}, 0.05) == Sight::kThrough);  // before it
  CHECK(sight.at({2.5, 0.0}, 0.05) == Sight::kUnseen);   // behind it
  CHECK(sight.at({2.0, 2.0}, 0.05) == Sight::kThrough);
  CHECK(sight.at({-1.0, 0.0}, 0.05) == Sight::kUnseen);  // outside 270 degrees
  // 2.5 m away and 0.2 m aside of the post's shadow, which is 0.126 m half wide there: half of 0.3 m of beams is
  // blocked.
  CHECK(sight.at({2.5, 0.25}, 0.05) == Sight::kThrough);
  CHECK(sight.at({2.5, 0.14}, 0.05) == Sight::kUnseen);
}

TEST_CASE("beside the first beam of a scan all round lies the last") {
  const Room room = with({{{2.0, -0.06}, 0.05}});  // from 0.3 to 3.2 degrees right of ahead
  const LaserScan scan = scan_of(room, {}, 1, 0.0, {.beams = 720, .first_rad = 0.0, .step_rad = kPi / 360.0});
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({1.95, 0.02}, 0.08) == Sight::kThere);              // 2.35 degrees of tolerance, to the left of ahead
  CHECK(sight.at({1.95, 0.02}, 0.08, {710, 1}) == Sight::kThrough);  // those that end on it are not asked
  CHECK(sight.at({3.0, 0.02}, 0.08) == Sight::kUnseen);              // half behind it
}

TEST_CASE("a place where beams find nothing in their reach is empty, one where they were not measured is unseen") {
  LaserScan scan = scan_of({.discs = {{{2.0, 0.0}, 0.1}}}, {}, 1);  // reaches 20 m
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({2.0, 1.0}, 0.05) == Sight::kEmpty);
  CHECK(sight.at({0.0, 15.9}, 0.05) == Sight::kEmpty);
  CHECK(sight.at({0.0, 16.1}, 0.05) == Sight::kUnseen);  // what is dark is not seen from so far
  CHECK(sight.at({1.9, 0.0}, 0.05) == Sight::kThere);
  CHECK(sight.at({2.5, 0.14}, 0.05) == Sight::kUnseen);  // half behind the post
  for (const float none : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    for (float& range : scan.range_m) range = range < 20.0F ? range : none;
    CHECK(sight.at({2.0, 1.0}, 0.05) == Sight::kUnseen);
  }
}

TEST_CASE("beams that are not asked say nothing") {
  const LaserScan scan = scan_of(kPost, {}, 1);
  const LineOfSight sight(scan, {}, {}, {});
  // Beam 405 is straight ahead, a third of a degree from the next. The post is seen by those within 2.87 degrees of it,
  // 397 to 413; the place is 3.6 degrees aside, at beam 415.8, and three beams to either side of it are asked.
  CHECK(sight.at({1.9, 0.12}, 0.1) == Sight::kThere);
  CHECK(sight.at({1.9, 0.12}, 0.1, {397, 413}) == Sight::kThrough);
  CHECK(sight.at({1.9, 0.12}, 0.1, {0, 810}) == Sight::kUnseen);
}

TEST_CASE("a clockwise scanner sees the same places") {
  const LaserScan scan = scan_of(kPost, {}, 1, 0.0, {.first_rad = 0.75 * kPi, .step_rad = -1.5 * kPi / 810});
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({1.9, 0.0}, 0.05) == Sight::kThere);
  CHECK(sight.at({0.0, 2.0}, 0.05) == Sight::kThrough);
}

TEST_CASE("a robot that turns during the sweep looks along the beam that was there then") {
  // The beam to the post is number 405 of 811, in the middle of a sweep of 0.1 s: at 2 rad/s the robot has turned 0.1
  // rad by then, and the beam that ends on the post is another, 0.1 rad back. Beam k looks along -3/4 pi + k step + 0.2
  // k/810.
  LaserScan scan = scan_of(rectangle(12.0, 10.0), {}, 1);
  scan.sweep = duration_from_seconds(0.1);
  const double per_beam = static_cast<double>(scan.angle_step_rad) + 0.2 / 810.0;
  for (std::uint32_t b = 0; b < scan.beam_count; ++b) {
    const double looks = static_cast<double>(scan.first_angle_rad) + per_beam * b;
    scan.range_m[b] = std::fabs(looks) < 0.05 ? 1.9F : 5.0F;
  }
  const LineOfSight turning(scan, {}, {}, {.v_mps = 0.0, .w_radps = 2.0}), standing(scan, {}, {}, {});
  CHECK(turning.at({1.9, 0.0}, 0.05) == Sight::kThere);
  CHECK(standing.at({1.9, 0.0}, 0.05) == Sight::kThrough);
}

TEST_CASE("a scan without beams, or beams all of one direction, sees nothing, whatever ranges it holds") {
  LaserScan scan = scan_of(kPost, {}, 1);
  const Vec2 place = direction(scan.angle_rad(0) - 0.3 * static_cast<double>(scan.angle_step_rad));  // beam -0.3
  CHECK(LineOfSight(scan, {}, {}, {}).at(place, 0.05) == Sight::kThrough);
  LaserScan no_fan = scan;
  no_fan.angle_step_rad = 0.0F;
  CHECK(LineOfSight(no_fan, {}, {}, {}).at({1.5, 0.0}, 0.05) == Sight::kUnseen);
  scan.beam_count = 0;
  CHECK(LineOfSight(scan, {}, {}, {}).at(place, 0.05) == Sight::kUnseen);
}

TEST_CASE("a disc that is half as wide as it is far is seen under 60 degrees, a mean of 0.5385 before its centre") {
  // a = pi/6: (1 + 0.5 * 0.866025 / 0.523599) / 2 = 0.913497, less pi * 0.25 / (4 * 0.523599) = 0.375: 0.538497
  const SeenDisc disc = seen_disc(0.538497, kPi / 3.0);
  CHECK(disc.range_m == Approx(1.0).margin(1e-5));
  CHECK(disc.radius_m == Approx(0.5).margin(1e-5));
  CHECK(seen_disc(10.0, 0.02).range_m - 10.0 ==
        Approx(0.1 * kPi / 4.0).epsilon(0.02));  // far off: pi / 4 of its radius
}

TEST_CASE("of a disc of known width one side tells where its middle is") {
  constexpr double kRange = 1.5, kRadius = 0.4;
  const double half = 0.26993;  // asin(0.4 / 1.5)
  for (const double seen : {0.1, 0.2, 0.4, 2.0 * half}) {
    Vec2 sum;  // of points, from the edge on
    constexpr int kPoints = 1000;
    for (int k = 0; k < kPoints; ++k) {
      const double t = -half + seen * (k + 0.5) / kPoints, u = kRange * jaywalk::sin(t);
      sum = sum + direction(t) * (kRange * jaywalk::cos(t) - std::sqrt(std::fmax(0.0, kRadius * kRadius - u * u)));
    }
    const Vec2 mean = sum * (1.0 / kPoints);
    const SeenDisc disc = seen_side(kRadius, seen, norm(mean), half + jaywalk::atan2(mean.y, mean.x));
    CHECK(disc.range_m == Approx(kRange).margin(0.003));
    CHECK(disc.bearing_rad == Approx(half).margin(0.001));
  }
}

TEST_CASE("a walker is within the 95 percent bound that its track claims, whatever its radius") {
  for (const double radius_m : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    INFO("radius " << radius_m);
    const Counted counted = followed(radius_m);
    CHECK(counted.claimed > 60);
    CHECK(counted.within >= 0.95 * counted.claimed);
  }
}
