#include "planner/mapping/evidence_map.h"

#include <cmath>

#include "tests/planner/test_maps.h"
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

TEST_CASE("a row of evidence is what its cells have, beyond the map and across the torus's seam too") {
  EvidenceMap map(64, 0.1, {3.0, 3.0});
  map.roll_to({9.0, -7.0});
  test::Random random(3);
  const CellIndex low = map.low();
  for (std::int32_t k = 0; k < 64 * 64; ++k) map.add({low.i + k % 64, low.j + k / 64}, random.below(129) - 64);
  for (std::int32_t j = low.j - 2; j < low.j + 66; ++j) {
    const CellIndex first{low.i - 40 + random.below(60), j};
    std::array<std::int8_t, 128> row{};
    const std::int32_t count = 1 + random.below(128);
    map.copy_row(first, count, row.data());
    for (std::int32_t k = 0; k < count; ++k) {
      REQUIRE(row[static_cast<std::size_t>(k)] == map.evidence({first.i + k, j}));
    }
  }
}

TEST_CASE("a map that follows another has all of it, whatever has been added, hit, forgotten and rolled since") {
  EvidenceMap map(64, 0.1, {});
  EvidenceMap follower = map;
  test::Random random(5);
  const auto any = [&] { return CellIndex{map.low().i + random.below(70) - 3, map.low().j + random.below(70) - 3}; };
  for (int tick = 0; tick < 200; ++tick) {
    for (std::int32_t k = random.below(9); k > 0; --k) {
      const std::int32_t what = random.below(4);
      const CellIndex cell = any();
      if (what == 0) map.add(cell, random.below(100) - 50);
      if (what == 1) map.add_hit(map.centre_of(cell) + Vec2{0.02, random.unit() * 0.04}, 20, 0.2, {1.0, 0.0});
      if (what == 2) map.forget(cell);
      if (what == 3 && random.below(20) == 0) map.roll_to(map.centre_of(cell));
    }
    if (tick % 3 == 0) continue;
    follower.follow(map);
    REQUIRE(follower.low() == map.low());
    for (std::int32_t k = 0; k < 64 * 64; ++k) {
      const CellIndex cell{map.low().i + k % 64, map.low().j + k / 64};
      REQUIRE(follower.evidence(cell) == map.evidence(cell));
      REQUIRE(follower.stands(cell) == map.stands(cell));
      REQUIRE(follower.surface(cell) == map.surface(cell));
      REQUIRE(follower.to_laser(cell) == map.to_laser(cell));
    }
  }
  EvidenceMap other(64, 0.1, {3.0, 3.0});
  other.add({30, 30}, 50);
  follower.follow(other);
  CHECK(follower.evidence({30, 30}) == 50);
}

TEST_CASE("what a map tells of a cell is believed, where its surface lies the first hit says") {
  EvidenceMap map(64, 0.1, {0.0, 0.0});
  map.tell({0, 0}, 40, {0.09, 0.05});
  map.tell({1, 0}, -40, {0.15, 0.05});
  CHECK(map.occupied({0, 0}));
  CHECK(map.stands({0, 0}));
  CHECK(map.seen_free({1, 0}));
  CHECK(map.surface({0, 0}).x == Approx(0.09).margin(0.0005));  // to 1/128 of half a cell
  CHECK(map.to_laser({0, 0}) == Vec2{});
  for (const Vec2 side : {Vec2{1.0, 0.0}, {0.0, -1.0}, {-1.0, 0.0}, {0.0, 1.0}}) {
    map.tell({5, 5}, 40, {0.55, 0.55}, side);
    CHECK(map.to_laser({5, 5}) == side);
  }
  map.tell({5, 5}, 40, {0.55, 0.55}, {-1.0, 2.0});
  CHECK(map.to_laser({5, 5}).y == Approx(std::sqrt(0.5)));
  map.add_hit({0.02, 0.06}, 10, 0.05, {1.0, 0.0});
  CHECK(map.evidence({0, 0}) == 50);
  CHECK(map.surface({0, 0}).x == Approx(0.02).margin(0.0005));
  CHECK(map.to_laser({0, 0}).x == 1.0);
  map.add_hit({0.10 - 1e-9, 0.06}, 10, 0.05, {1.0, 0.0});  // and from then on a mean
  CHECK(map.surface({0, 0}).x == Approx(0.03).margin(0.0005));
}
