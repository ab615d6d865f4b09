// What the supervisor is told of walls where no laser looks: supposed ones are forgotten when they are out of reach or
// free.
#include "firmware/estimator.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a supposed wall stays in its place as the robot moves, until that is seen free or out of reach") {
  EvidenceMap map(128, 0.1, {0.0, 0.0});
  KnownWalls walls(Footprint{.front_m = 0.75, .rear_m = 0.35, .half_width_m = 0.325});
  CHECK(walls.near(map, {0.0, 0.0, 0.0}).empty());
  for (int look = 0; look < 3; ++look) walls.suppose({-0.2, 0.37 + 0.005 * look});

  const std::span<const Vec2> seen = walls.near(map, {0.3, 0.0, 0.5 * kPi});
  REQUIRE(seen.size() == 1);  // three looks at one place
  CHECK(seen[0].x == Approx(0.37));
  CHECK(seen[0].y == Approx(0.5));

  SECTION("far away") {
    CHECK(walls.near(map, {3.0, 0.0, 0.0}).empty());
    CHECK(walls.near(map, {0.0, 0.0, 0.0}).empty());
  }
  SECTION("seen free") {
    map.add(map.cell_at({-0.2, 0.37}), EvidenceMap::kMin);
    CHECK(walls.near(map, {0.0, 0.0, 0.0}).empty());
  }
}
