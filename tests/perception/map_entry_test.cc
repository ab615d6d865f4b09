#include "planner/mapping/map_entry.h"

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Entered {
  EvidenceMap map{64, 0.1, {0.0, 0.0}};
  MapEntry entry{map};
  std::array<Vec2, kMaxBeams> points{};
  Entries entries{};
  double step_s = 0.0;

  void enter(std::initializer_list<Vec2> ends, Becomes what, int times) {
    std::size_t n = 0;
    for (const Vec2& p : ends) entries[n] = what, points[n++] = p;
    for (int k = 0; k < times; ++k) entry.enter(map, {0.05, 0.05}, points, entries, n, step_s);
  }
};

}  // namespace

TEST_CASE("two scans make an obstacle and three make free space before it") {
  Entered e;
  e.enter({{1.05, 0.05}}, Becomes::kWall, 2);
  CHECK(e.map.occupied({10, 0}));
  CHECK_FALSE(e.map.seen_free({5, 0}));
  e.enter({{1.05, 0.05}}, Becomes::kWall, 1);
  CHECK(e.map.seen_free({5, 0}));
  CHECK(e.map.seen_free({9, 0}));       // up to just before the hit
  CHECK(e.map.evidence({11, 0}) == 0);  // and nothing behind it
}

TEST_CASE("a beam frees every cell that it crosses, also on a slant") {
  Entered e;
  e.enter({{0.35, 0.25}}, Becomes::kWall, 3);
  // From (0.05, 0.05) with slope 2/3 the border x = 0.1 is crossed at y = 0.083, then y = 0.1 at x = 0.125,
  // x = 0.2 at y = 0.15, y = 0.2 at x = 0.275, x = 0.3 at y = 0.217: cells (0,0) (1,0) (1,1) (2,1) (2,2) (3,2).
  for (const CellIndex c : {CellIndex{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}}) CHECK(e.map.seen_free(c));
  CHECK(e.map.occupied({3, 2}));
  CHECK(e.map.evidence({2, 0}) == 0);
  CHECK(e.map.evidence({0, 1}) == 0);
}

TEST_CASE("a cell changes once a scan, and an end counts more than passing beams") {
  Entered e;
  e.enter({{0.55, 0.05}, {1.05, 0.05}, {1.05, 0.06}}, Becomes::kWall, 1);
  CHECK(e.map.evidence({5, 0}) > 0);  // beams to 1.05 pass through it
  CHECK(e.map.evidence({10, 0}) == e.map.evidence({5, 0}));
  CHECK(e.map.evidence({2, 0}) < 0);
}

TEST_CASE("what moves frees the way to it and leaves no mark") {
  Entered e;
  e.enter({{1.05, 0.05}}, Becomes::kNothing, 5);
  CHECK(e.map.evidence({10, 0}) == 0);
  CHECK(e.map.seen_free({9, 0}));
}

TEST_CASE("where somebody may stand is an obstacle and no wall however long it is seen") {
  Entered e;
  e.step_s = 0.1;
  e.enter({{1.05, 0.05}}, Becomes::kObstacle, 20);
  CHECK(e.map.occupied({10, 0}));
  CHECK_FALSE(e.map.stands({10, 0}));
  e.enter({{1.05, 0.05}}, Becomes::kWall, 9);
  CHECK_FALSE(e.map.stands({10, 0}));
  e.enter({{1.05, 0.05}}, Becomes::kWall, 1);
  CHECK(e.map.stands({10, 0}));
}

TEST_CASE("a ghost is gone within nine scans that look through it") {
  Entered e;
  e.enter({{0.55, 0.05}}, Becomes::kWall, 50);
  REQUIRE(e.map.evidence({5, 0}) == EvidenceMap::kMax);
  e.enter({{1.05, 0.05}}, Becomes::kWall, 9);  // 64 - 9 x 6 = 10
  CHECK_FALSE(e.map.occupied({5, 0}));
}

TEST_CASE("a surface is remembered to a fraction of its cell") {
  Entered e;
  for (int k = 0; k < 40; ++k) e.enter({{1.02, 0.07}}, Becomes::kWall, 1);
  CHECK(e.map.surface({10, 0}).x == Approx(1.02).margin(0.002));
  CHECK(e.map.surface({10, 0}).y == Approx(0.07).margin(0.002));
}

TEST_CASE("a beam without a return marks unknown cells as observed, frees none and clears no wall") {
  Entered e;
  e.enter({{1.05, 0.05}}, Becomes::kWall, 2);
  for (int k = 0; k < 50; ++k) MapEntry::mark_observed(e.map, {0.05, 0.05}, {2.05, 0.05});
  CHECK(e.map.occupied({10, 0}));
  CHECK(e.map.evidence({15, 0}) != 0);
  CHECK_FALSE(e.map.seen_free({15, 0}));
  CHECK(e.map.evidence({20, 0}) == 0);  // the beam's last cell and the cells beside it stay unknown
  CHECK(e.map.evidence({15, 1}) == 0);
  MapEntry::mark_observed(e.map, {0.05, 0.05}, {1e9, 0.05});  // ends at the map's rim
}
