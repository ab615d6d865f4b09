#include <cmath>

#include "hal/types/trig.h"
#include "planner/scan/line_of_sight.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

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
  Watch watch;
  watch.look_round();
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
