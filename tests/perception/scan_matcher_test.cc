#include "planner/localization/scan_matcher.h"

#include <array>
#include <cmath>
#include <memory>

#include "planner/localization/correlative_search.h"
#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// The map after two seconds of standing in `room`.
std::unique_ptr<Tracker> known(const Room& room) {
  auto tracker =
      std::make_unique<Tracker>(PerceptionConfig{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}});
  for (std::uint32_t k = 1; k <= 30; ++k) tracker->update(scan_of(room, {}, k), {});
  return tracker;
}

MatchResult match(const Tracker& tracker, const Room& seen) {
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan_of(seen, {}, 40), {}, {}, *points);
  return match_sample(sample_of(*points), {tracker.still()}, {{}, diagonal(1e-4, 1e-4, 1e-5)});
}

constexpr Vec2 kBelow{0.0, -2.0}, kAbove{0.0, 2.0};

/// Hits a hand's breadth apart on a face from (-1, y) to (1, y).
void see_face(EvidenceMap& map, double y, Vec2 laser) {
  for (int k = -20; k <= 20; ++k) {
    const Vec2 p{0.05 * k, y};
    map.add_hit(p, 10, 0.0, (laser - p) * (1.0 / distance(laser, p)));
  }
}

/// A wall 2 m ahead of the laser, a point every 5 cm.
MatchSample wall_ahead(double off_m) {
  MatchSample sample;
  for (int k = -20; k <= 20; ++k) (void)sample.push_back({2.03 + off_m, 0.05 * k});
  return sample;
}

bool holds(const EvidenceMap& map, Vec2 p) { return map.evidence(map.cell_at(p)) > 0; }

/// The points that are left at `now_s` of those on the robot's x axis, every 10 cm from 1.0 to 2.0 m. The
/// robot stands at (3, 4) and looks along +y; a walker, seen at 5 s 1.25 m ahead, walks away from it at 1 m/s.
std::vector<int> left_at(double now_s) {
  const auto points = std::make_unique<ScanPoints>();
  for (std::uint32_t k = 10; k <= 20; ++k) (void)points->push_back({{0.1 * k, 0.0}, 0.1 * k, k});
  Track walker;
  walker.stamp = time_from_seconds(5.0);
  walker.position_in_map = {3.0, 5.25};
  walker.velocity_in_map = {0.0, 1.0};
  walker.radius_m = 0.12;
  mask_moving_tracks(std::array{walker}, {3.0, 4.0, kPi / 2}, time_from_seconds(now_s), *points);
  std::vector<int> left;
  for (const ScanPoint& point : *points) left.push_back(static_cast<int>(point.beam));
  return left;
}

}  // namespace

TEST_CASE("a scan of what the map holds is matched, one of other walls is contradicted") {
  const auto tracker = known(rectangle(8.0, 6.0));
  const MatchResult same = match(*tracker, rectangle(8.0, 6.0));
  CHECK(same.matched);
  CHECK_FALSE(same.contradicted);
  CHECK(same.fit > 0.9);
  const MatchResult other = match(*tracker, rectangle(4.0, 3.0));  // where the map knows free space
  CHECK_FALSE(other.matched);
  CHECK(other.contradicted);
}

TEST_CASE("a scan of which the map knows next to nothing is neither matched nor contradicted") {
  const auto tracker = known(rectangle(8.0, 6.0));
  Room beyond;  // the walls are gone, and farther off stand others
  beyond.walls = rectangle(14.0, 12.0).walls;
  beyond.discs = {{{2.0, 0.0}, 0.3}};  // in the open, a few beams wide
  const MatchResult result = match(*tracker, beyond);
  CHECK(result.points_used > 200);
  CHECK_FALSE(result.matched);
  CHECK_FALSE(result.contradicted);
}

TEST_CASE("a piece of wall that fifteen beams meet is enough to be matched, one that ten meet is not") {
  const auto tracker = known(rectangle(8.0, 6.0));
  const auto piece = [](double width_m) {
    return Room{.walls = {{{4.0, -0.5 * width_m}, {4.0, 0.5 * width_m}}}, .discs = {}};
  };
  const MatchResult enough = match(*tracker, piece(0.45));
  CHECK(enough.points_used < 22);
  CHECK(enough.matched);
  CHECK_FALSE(match(*tracker, piece(0.25)).matched);
}

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

TEST_CASE("what lies on a walker where he is by now is left out and the rest keeps its order") {
  // He is 1.45 m ahead, 0.32 m with a hand on each side: 1.2 to 1.7 m are his.
  CHECK(left_at(5.2) == std::vector{10, 11, 18, 19, 20});
}

TEST_CASE("a walker seen long ago is not followed for longer than a quarter second, nor back in time") {
  CHECK(left_at(9.0) == std::vector{10, 11, 19, 20});      // 1.5 m: 1.2 to 1.8
  CHECK(left_at(4.0) == std::vector{16, 17, 18, 19, 20});  // 1.25 m: 1.0 to 1.5
}
