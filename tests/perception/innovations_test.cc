#include "bench/tracking/innovations.h"

#include <cmath>

#include "planner/perception/kalman.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

Track walker() {
  Track track;
  track.id = 3;
  track.moving = true;
  track.velocity_in_map = {1.0, 0.0};
  track.covariance = {.pp = 0.02, .pv = 0.01, .vv = 0.1};
  return track;
}

/// Sees the track `dt_s` later at a place and returns what the gate made of it.
double see(Track& track, double dt_s, Vec2 place, double std_m) {
  predict(track, dt_s, kBodyAccelStd);
  track.stamp += duration_from_seconds(dt_s);
  const double squared = gate_distance2(track, place, std_m);
  correct(track, place, std_m);
  track.hits += 1;
  return squared;
}

}  // namespace

TEST_CASE("an innovation told from the tracks before and after is the one that the gate saw") {
  Track track = walker();
  track.stamp = time_from_seconds(5.0);
  bench::Innovations innovations;
  innovations.add({&track, 1});
  const double first = see(track, 0.1, {0.3, 0.1}, 0.05);  // 0.2 m and 0.1 m off
  innovations.add({&track, 1});
  CHECK(innovations.mean() == Approx(first));
  const double second = see(track, 0.1, {1.5, 0.1}, 0.05);  // more than a metre off
  innovations.add({&track, 1});
  CHECK(first < 5.99);
  CHECK(second > 5.99);
  CHECK(innovations.count() == 2);
  CHECK(innovations.mean() == Approx(0.5 * (first + second)));
  CHECK(innovations.share_within_95() == 0.5);
  CHECK(innovations.mean_bound() == Approx(1.96 * 2.0 / std::sqrt(2.0)));
}

TEST_CASE("what was not seen, stands, or is new tells no innovation") {
  Track track = walker();
  track.stamp = time_from_seconds(5.0);
  bench::Innovations innovations;
  innovations.add({&track, 1});  // new
  predict(track, 0.1, kBodyAccelStd);
  track.stamp += duration_from_seconds(0.1);
  innovations.add({&track, 1});  // not seen
  track.moving = false;
  (void)see(track, 0.1, {0.2, 0.0}, 0.05);
  innovations.add({&track, 1});  // stands
  CHECK(innovations.count() == 0);
  CHECK(std::isnan(innovations.mean()));
}
