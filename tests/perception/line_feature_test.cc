#include <cmath>

#include "planner/localization/scan_matcher.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr Vec2 kBelow{0.0, -2.0}, kAbove{0.0, 2.0};

/// Hits a hand's breadth apart on a face from (-1, y) to (1, y).
void see_face(EvidenceMap& map, double y, Vec2 laser) {
  for (int k = -20; k <= 20; ++k) {
    const Vec2 p{0.05 * k, y};
    map.add_hit(p, 10, 0.0, (laser - p) * (1.0 / distance(laser, p)));
  }
}

}  // namespace

TEST_CASE("of a wall of 20 cm the face is found that looks at the robot") {
  EvidenceMap map(64, 0.1, {});
  see_face(map, 0.05, kBelow);
  see_face(map, 0.25, kAbove);
  LineFeature wall;
  REQUIRE(line_feature_near(map, {0.02, 0.07}, kBelow, wall));
  CHECK(wall.point.y == Approx(0.05).margin(0.001));
  CHECK(std::fabs(wall.normal.y) == Approx(1.0));
  REQUIRE(line_feature_near(map, {0.02, 0.27}, kAbove, wall));
  CHECK(wall.point.y == Approx(0.25).margin(0.001));
}

TEST_CASE("a face that is known from its other side alone is none to match against") {
  EvidenceMap map(64, 0.1, {});
  see_face(map, 0.05, kBelow);
  LineFeature wall;
  CHECK(line_feature_near(map, {0.0, 0.15}, kBelow, wall));
  CHECK_FALSE(line_feature_near(map, {0.0, 0.15}, kAbove, wall));
}

TEST_CASE("a face looked at along itself is found, whatever side scatter puts the robot on") {
  EvidenceMap map(64, 0.1, {});
  see_face(map, 0.05, {9.0, 0.1});
  LineFeature wall;
  CHECK(line_feature_near(map, {0.0, 0.05}, {9.0, 0.1}, wall));
  CHECK(line_feature_near(map, {0.0, 0.05}, {9.0, 0.0}, wall));
}

TEST_CASE("surfaces that nobody knows the side of are seen from both, and a heap has no direction") {
  EvidenceMap map(64, 0.1, {});
  for (int k = -20; k <= 20; ++k) map.add_hit({0.05 * k, 0.05}, 10);
  LineFeature wall;
  CHECK(line_feature_near(map, {0.0, 0.05}, kBelow, wall));
  CHECK(line_feature_near(map, {0.0, 0.05}, kAbove, wall));
  CHECK_FALSE(line_feature_near(map, {0.0, 0.95}, kAbove, wall));
  for (const Vec2 p : {Vec2{-0.45, 1.05}, Vec2{-0.25, 1.05}, Vec2{-0.35, 0.95}, Vec2{-0.35, 1.15}}) map.add_hit(p, 10);
  CHECK_FALSE(line_feature_near(map, {-0.35, 1.05}, kBelow, wall));
}
