#include "hal/types/map_zones.h"

#include <algorithm>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// An L of two squares of 1 m beside each other and one on top of the left.
const MapZone kEll{ZoneKind::kKeepOut, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 0.0};

}  // namespace

TEST_CASE("the distance to a zone is that to its nearest side, below 0 inside, whichever way its corners go round") {
  MapZone zone = kEll;
  if (GENERATE(false, true)) std::reverse(zone.corners.begin(), zone.corners.end());
  CHECK(signed_distance(zone, {3.0, 0.5}) == Approx(1.0));
  CHECK(signed_distance(zone, {3.0, 2.0}) == Approx(1.414213562));  // to the corner (2, 1)
  CHECK(signed_distance(zone, {1.5, 1.5}) == Approx(0.5));          // in the notch
  CHECK(signed_distance(zone, {0.5, 0.75}) == Approx(-0.5));
  CHECK(signed_distance(zone, {0.75, 0.75}) == Approx(-0.3535533906));  // to the notch's corner
}

TEST_CASE("kept out is what lies in a keep-out zone or too near one, a speed zone keeps nothing out") {
  const std::vector<MapZone> zones{kEll, {ZoneKind::kSpeed, {{5, 0}, {6, 0}, {6, 1}}, 0.3}};
  CHECK(is_kept_out(zones, {0.5, 0.5}, 0.0));
  CHECK(is_kept_out(zones, {2.2, 0.5}, 0.25));
  CHECK_FALSE(is_kept_out(zones, {2.2, 0.5}, 0.15));
  CHECK_FALSE(is_kept_out(zones, {5.8, 0.3}, 0.25));
}
