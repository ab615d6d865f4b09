// Windows of more than 512 cells a side: what two cycles come to, and what the submissions after them find.
#include <cstdio>
#include <vector>

#include "bench/field/random_maps.h"
#include "planner/paper/map_field.h"
#include "planner/paper/multigrid.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr std::int32_t kSide = 2 * paper::kLargeSide;
constexpr std::uint8_t kNone = 4;

/// Which of its four neighbours a cell would go to: the lowest, if that is lower than itself.
std::uint8_t pick(const paper::MapField& field, std::int32_t i, std::int32_t j) {
  const CellIndex beside[] = {{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}};
  float lowest = field.psi(i, j);
  std::uint8_t picked = kNone;
  for (std::uint8_t k = 0; k < 4; ++k) {
    const auto [x, y] = beside[k];
    const bool is_lower = x >= 0 && x < kSide && y >= 0 && y < kSide && field.psi(x, y) < lowest;
    if (is_lower) lowest = field.psi(x, y), picked = k;
  }
  return picked;
}

std::vector<std::uint8_t> picks(const paper::MapField& field) {
  std::vector<std::uint8_t> all;
  for (std::int32_t j = 0; j < kSide; ++j) {
    for (std::int32_t i = 0; i < kSide; ++i) all.push_back(pick(field, i, j));
  }
  return all;
}

/// Share of the cells that pick one in `b` which pick the same in `a`.
double alike(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double same = 0.0, all = 0.0;
  for (std::size_t c = 0; c < b.size(); ++c) {
    if (b[c] == kNone) continue;
    same += a[c] == b[c] ? 1.0 : 0.0;
    all += 1.0;
  }
  return same / all;
}

}  // namespace

TEST_CASE("in large windows two cycles guide from everywhere, and the next submission finds what they lack") {
  for (const MapKind kind : {MapKind::kRooms, MapKind::kCave, MapKind::kBoxes}) {
    MapRandom random(3);
    const auto field = paper::make_cpu_map_field(random_map(kind, kSide, random));
    field->inflate(2.0F);
    CellIndex goal{kSide / 2, kSide / 2};
    REQUIRE(field->nearest_free(goal, kSide));
    const paper::MapQuality cold = field->solve_cold(goal);
    CHECK(cold.certified);
    CHECK(cold.cycles == 2);
    CHECK(cold.joined > 100000);
    CHECK(field->reach(goal) == 1.0F);
    const std::vector<std::uint8_t> first = picks(*field);
    CHECK(field->solve_warm(goal).certified);
    CHECK(field->reach(goal) == 1.0F);
    const std::vector<std::uint8_t> next = picks(*field);
    for (int k = 0; k < 8; ++k) (void)field->solve_warm(goal);
    const std::vector<std::uint8_t> last = picks(*field);
    std::printf(
        "%s, %d cells a side: of the picks that ten submissions come to, the first has %.3f %%, the second %.3f %%\n",
        name_of(kind), kSide, 100.0 * alike(first, last), 100.0 * alike(next, last));
    CHECK(alike(first, last) > 0.98);
    CHECK(alike(next, last) > 0.999);
  }
}
