// Windows of more than 512 cells a side: what two cycles come to, and what the submissions after them find.
#include <vector>

#include "bench/field/random_maps.h"
#include "planner/paper/map_field.h"
#include "planner/paper/multigrid.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr std::int32_t kSide = 2 * paper::kLargeSide;

/// psi of all cells, by rows.
std::vector<float> psi_of(const paper::MapField& field) {
  std::vector<float> psi;
  for (std::int32_t c = 0; c < kSide * kSide; ++c) psi.push_back(field.psi(c % kSide, c / kSide));
  return psi;
}

/// Share of the cells whose lowest neighbour by `psi` is the lowest by `last`.
double alike(const std::vector<float>& psi, const std::vector<float>& last, CellIndex goal) {
  const paper::Grid grid{kSide};
  return paper::share_of_best(grid, psi.data(), {last.begin(), last.end()}, grid.at(goal.i, goal.j));
}

}  // namespace

TEST_CASE("in large windows two cycles guide from everywhere, and the next submission finds what they lack") {
  for (const MapKind kind : {MapKind::kRooms, MapKind::kCave, MapKind::kBoxes}) {
    MapRandom random(3);
    const auto field = paper::make_cpu_map_field(random_map(kind, kSide, random));
    field->inflate(2.0F);
    CellIndex goal{kSide / 2, kSide / 2};
    REQUIRE(field->nearest_free(goal, kSide));
    const paper::FieldQuality cold = field->solve_cold(goal);
    CHECK(cold.certified);
    CHECK(cold.cycles == 2);
    CHECK(cold.joined > 100000);
    CHECK(field->reach(goal) == 1.0F);
    const std::vector<float> first = psi_of(*field);
    CHECK(field->solve_warm(goal).certified);
    CHECK(field->reach(goal) == 1.0F);
    const std::vector<float> next = psi_of(*field);
    for (int k = 0; k < 8; ++k) (void)field->solve_warm(goal);
    const std::vector<float> last = psi_of(*field);
    CAPTURE(name_of(kind));
    CHECK(alike(first, last, goal) > 0.98);
    CHECK(alike(next, last, goal) > 0.999);
  }
}
