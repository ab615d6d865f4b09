#include "hal/types/geometry.h"

#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a pose takes a point of the robot to the map") {
  // Robot at (2, 1) looking along +y: one metre ahead of it is (2, 2), one to its left (1, 1).
  const Pose2 map_from_robot{2.0, 1.0, kPi / 2};
  const Vec2 ahead = map_from_robot * Vec2{1.0, 0.0};
  CHECK(ahead.x == Approx(2.0));
  CHECK(ahead.y == Approx(2.0));
  const Vec2 left = map_from_robot * Vec2{0.0, 1.0};
  CHECK(left.x == Approx(1.0));
  CHECK(left.y == Approx(1.0));
}

TEST_CASE("a pose times its inverse stays put") {
  const Pose2 p{3.0, -4.0, 2.5};
  const Pose2 none = p * inverse(p);
  CHECK(none.x == Approx(0.0).margin(1e-12));
  CHECK(none.y == Approx(0.0).margin(1e-12));
  CHECK(none.heading == Approx(0.0).margin(1e-12));
}

TEST_CASE("a full vector refuses and keeps what it has") {
  FixedVector<int, 2> v;
  CHECK(v.push_back(1));
  CHECK(v.push_back(2));
  CHECK_FALSE(v.push_back(3));
  CHECK(v.size() == 2);
  CHECK(v.back() == 2);
}

TEST_CASE("zero, NaN, infinity, the greatest range and what lies beyond the limits are no hits") {
  LaserScan scan;
  scan.range_min_m = 0.1F;
  scan.range_max_m = 10.0F;
  scan.beam_count = 7;
  scan.range_m = {};
  scan.range_m[0] = 0.0F;
  scan.range_m[1] = NAN;
  scan.range_m[2] = INFINITY;
  scan.range_m[3] = 0.05F;
  scan.range_m[4] = 10.5F;
  scan.range_m[5] = 10.0F;  // what many say for nothing
  scan.range_m[6] = 3.0F;
  for (std::size_t beam = 0; beam < 6; ++beam) CHECK_FALSE(scan.is_hit(beam));
  CHECK(scan.is_hit(6));
  for (const std::size_t beam : {2U, 4U, 5U}) CHECK(scan.found_nothing(beam));
  for (const std::size_t beam : {0U, 1U, 3U, 6U}) CHECK_FALSE(scan.found_nothing(beam));
  scan.range_max_m = INFINITY;  // a scanner that does not say how far it sees
  CHECK(scan.is_hit(4));
  CHECK_FALSE(scan.is_hit(2));
  CHECK(scan.found_nothing(2));
}

TEST_CASE("a beam proves a hit or free room or nothing, and a scan that holds nothing proves nothing") {
  LaserScan scan;
  CHECK(scan.state(0) == BeamState::kUnknown);  // no limits yet, and 0 is not beyond them
  scan.range_min_m = 0.1F;
  scan.range_max_m = 10.0F;
  const auto of = [&scan](float range_m) {
    scan.range_m[0] = range_m;
    return scan.state(0);
  };
  for (const float hit : {0.1F, 3.0F, 9.999F}) CHECK(of(hit) == BeamState::kHit);
  for (const float free : {10.0F, 10.5F, INFINITY}) CHECK(of(free) == BeamState::kFree);
  for (const float unknown : {0.0F, -0.0F, 0.05F, -1.0F, -INFINITY, NAN}) CHECK(of(unknown) == BeamState::kUnknown);
}

TEST_CASE("the P3-DX holds a circle of 21 cm and is held by one of 37 cm") {
  const Footprint body = p3dx().footprint;
  CHECK(body.inscribed_radius_m() == Approx(0.210));
  CHECK(body.circumscribed_radius_m() == Approx(0.36845).epsilon(1e-4));  // sqrt(0.301^2 + 0.2125^2)
  CHECK(body.distance_to({0.51, 0.0}) == Approx(0.3));
  CHECK(body.distance_to({0.0, 0.1}) == 0.0);
}
