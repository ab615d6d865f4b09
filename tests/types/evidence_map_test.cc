#include "planner/grid/evidence_map.h"

#include <cmath>

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("cells are anchored in the world: (-0.05, 0.25) lies in cell (-1, 2)") {
  const EvidenceMap map(64, 0.1, {0.0, 0.0});
  CHECK(map.cell_at({-0.05, 0.25}) == CellIndex{-1, 2});
  CHECK(map.centre_of({-1, 2}).x == Approx(-0.05));
  CHECK(map.centre_of({-1, 2}).y == Approx(0.25));
}

TEST_CASE("evidence saturates, so the map can change its mind") {
  EvidenceMap map(64, 0.1, {0.0, 0.0});
  for (int k = 0; k < 100; ++k) map.add({3, 4}, 8);
  CHECK(map.evidence({3, 4}) == EvidenceMap::kMax);
  CHECK(map.occupied({3, 4}));
  map.add({3, 4}, -100);
  CHECK(map.seen_free({3, 4}));
}

TEST_CASE("rolling keeps what stays inside and forgets what leaves") {
  EvidenceMap map(64, 0.1, {0.0, 0.0});
  map.add({20, 0}, 50);
  map.add({-30, 0}, 50);
  map.roll_to({2.0, 0.0});  // 20 cells on: more than a quarter side
  CHECK(map.evidence({20, 0}) == 50);
  CHECK_FALSE(map.contains({-30, 0}));
  CHECK(map.evidence({-30, 0}) == 0);
  map.roll_to({-2.0, 0.0});
  CHECK(map.evidence({-30, 0}) == 0);  // forgotten, though inside again
  CHECK(map.evidence({20, 0}) == 0);
}

TEST_CASE("small moves do not roll and what is outside is ignored") {
  EvidenceMap map(64, 0.1, {0.0, 0.0});
  map.roll_to({1.5, -1.5});
  CHECK(map.contains({-32, -32}));
  map.add({1000, 1000}, 50);
  CHECK(map.evidence({1000, 1000}) == 0);
}

TEST_CASE("a place that is farther off than integers count is in the last cell, one that is no number in the first") {
  const EvidenceMap map(64, 0.1, {0.0, 0.0});
  CHECK(map.cell_at({1e30, -1e30}) == CellIndex{500000000, -500000000});
  CHECK(map.cell_at({std::nan(""), -0.05}) == CellIndex{-500000000, -1});
  CHECK(map.cell_at({1e6, -1e6}) == CellIndex{10000000, -10000000});
}
