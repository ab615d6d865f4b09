#include <memory>

#include "planner/localization/correlative_search.h"
#include "planner/localization/scan_matcher.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// A wall 2 m ahead of the laser, a point every 5 cm.
MatchSample wall_ahead(double off_m) {
  MatchSample sample;
  for (int k = -20; k <= 20; ++k) (void)sample.push_back({2.03 + off_m, 0.05 * k});
  return sample;
}

bool holds(const EvidenceMap& map, Vec2 p) { return map.evidence(map.cell_at(p)) > 0; }

}  // namespace

TEST_CASE("where two keyframes saw a wall it lies between what they saw") {
  const auto submap = std::make_unique<Submap>();
  submap->add(wall_ahead(-0.01), {});
  submap->add(wall_ahead(0.03 - 0.5), {0.5, 0.0, 0.0});  // 2.02 m and 2.06 m from the first
  LineFeature wall;
  REQUIRE(line_feature_near(submap->about({}), {2.05, 0.0}, {}, wall));
  CHECK(wall.point.x == Approx(2.04).margin(0.001));
}

TEST_CASE("a scan from where the last keyframe was taken is none, and of nine keyframes the first is forgotten") {
  const auto submap = std::make_unique<Submap>();
  submap->add(wall_ahead(0.0), {});
  submap->add(wall_ahead(1.0), {0.3, 0.0, 0.0});
  CHECK(holds(submap->about({}), {2.03, 0.0}));
  CHECK_FALSE(holds(submap->about({}), {3.33, 0.0}));
  for (int k = 1; k <= 7; ++k) submap->add(wall_ahead(0.0), {0.0, 3.0 * k, 0.0});
  CHECK(holds(submap->about({}), {2.03, 0.0}));
  submap->add(wall_ahead(0.0), {0.0, 24.0, 0.0});
  CHECK_FALSE(holds(submap->about({}), {2.03, 0.0}));
  CHECK(holds(submap->about({}), {2.03, 3.0}));
}
