#include "hal/types/geometry.h"

#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a pose takes a point of the robot to the map") {
  // Robot at (2, 1) looking along +y: one metre ahead of it is (2, 2), one to its left (1, 1).
  const Pose2 map_from_robot{2.0, 1.0, kPi / 2};
  CHECK(distance(map_from_robot * Vec2{1.0, 0.0}, {2.0, 2.0}) < 1e-9);
  CHECK(distance(map_from_robot * Vec2{0.0, 1.0}, {1.0, 1.0}) < 1e-9);
}

TEST_CASE("a pose times its inverse stays put") {
  const Pose2 p{3.0, -4.0, 2.5};
  const Pose2 none = p * inverse(p);
  CHECK(norm(none.position()) == Approx(0.0).margin(1e-12));
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

TEST_CASE("a beam proves a hit or free room or nothing, and a scan that holds nothing proves nothing") {
  LaserScan scan;
  CHECK(scan.state(0) == BeamState::kUnknown);  // no limits yet, and 0 is not beyond them
  scan.range_min_m = 0.1F;
  scan.range_max_m = 10.0F;
  const auto of = [&scan](float range_m) {
    scan.range_m[0] = range_m;
    CHECK(scan.is_hit(0) == (scan.state(0) == BeamState::kHit));
    CHECK(scan.found_nothing(0) == (scan.state(0) == BeamState::kFree));
    return scan.state(0);
  };
  for (const float hit : {0.1F, 3.0F, 9.999F}) CHECK(of(hit) == BeamState::kHit);
  for (const float free : {10.0F, 10.5F, INFINITY}) CHECK(of(free) == BeamState::kFree);
  for (const float unknown : {0.0F, -0.0F, 0.05F, -1.0F, -INFINITY, NAN}) CHECK(of(unknown) == BeamState::kUnknown);
  scan.range_max_m = INFINITY;  // a scanner that does not say how far it sees
  CHECK(of(10.5F) == BeamState::kHit);
  CHECK(of(INFINITY) == BeamState::kFree);
}

TEST_CASE("the P3-DX holds a circle of 21 cm and is held by one of 37 cm") {
  const Footprint body = p3dx().footprint;
  CHECK(body.inscribed_radius_m() == Approx(0.210));
  CHECK(body.circumscribed_radius_m() == Approx(0.36845).epsilon(1e-4));  // sqrt(0.301^2 + 0.2125^2)
  CHECK(body.distance_to({0.51, 0.0}) == Approx(0.3));
  CHECK(body.distance_to({0.0, 0.1}) == 0.0);
}
