#include <algorithm>
#include <cstring>
#include <vector>

#include "tests/planner/field_rig.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

TEST_CASE("the start field descends to the goal from every joined cell of every map") {
  FieldRig<> rig(256);
  auto* const psi = paper::take_rows<float>(rig.executor, 256);
  std::vector<paper::Counted> rows(256);
  for (const TestMap& map : {open_room(), office(), serpentine(15), serpentine(10), clutter(3), speckle(3)}) {
    rig.load(map, 3.0F, rig.grid.at(12, map.name[1] == 'e' ? 6 : 12));  // less room in the serpentines
    std::copy_n(rig.arrays().start_psi, rig.grid.cells(), psi);
    rig.executor.for_each_cell(256, 1, paper::PitsOfRow{rig.grid, rig.goal, psi, rows.data()});
    const paper::Counted pits = rig.executor.total(256, rows.data());
    CHECK(pits.joined > 8000);
    CHECK(pits.cells == 0);
  }
}

TEST_CASE("a straight corridor costs its rate a cell") {
  // Five free rows between walls: on the middle row D = 3, and 2 across: width 5. Half of acosh(2 - cos(pi/6)) =
  // 0.51223 is 1049 units. Ten steps cost 20 * 1049.
  TestMap map("corridor", 64);
  map.box(0, 0, 64, 10), map.box(0, 15, 64, 64);
  FieldRig<> rig(64);
  rig.load(map, 0.0F, rig.grid.at(20, 12));
  CHECK(rig.arrays().start_psi[rig.grid.at(30, 12)] == Approx(20.0 * 1049.0 / 4096.0));
}

TEST_CASE(
    "the start field is the one fixed point of its steps: asking every cell of its neighbours comes to the same") {
  FieldRig<> rig(64);
  rig.load(rooms(), 1.0F, rig.grid.at(10, 10));
  paper::StartField field(64);
  std::vector<float> psi(64 * 64);
  REQUIRE(field.settle(rig.grid, rig.goal, rig.arrays().clearance, psi.data()));
  CHECK(std::memcmp(psi.data(), rig.arrays().start_psi, psi.size() * sizeof(float)) == 0);
  std::vector<std::uint32_t> cost(psi.size(), field::kNoWay);
  cost[static_cast<std::size_t>(rig.goal)] = 0;
  const auto rate = [&](std::int32_t i, std::int32_t j) { return rig.grid.holds(i, j) ? field.rate(i, j) : 0U; };
  for (bool any = true; any;) {
    any = false;
    for (std::int32_t c = 0; c < rig.grid.cells(); ++c) {
      const std::int32_t i = c % 64, j = c / 64;
      for (std::int32_t k = 0; k < 9 && rate(i, j) != 0; ++k) {
        const std::int32_t x = i + k % 3 - 1, y = j + k / 3 - 1;
        if (k == 4 || rate(x, y) == 0 || rate(x, j) == 0 || rate(i, y) == 0) continue;
        const std::uint32_t there = cost[static_cast<std::size_t>(rig.grid.at(x, y))];
        const std::uint32_t step = x == i || y == j
                                       ? paper::straight_step(rate(x, y), rate(i, j))
                                       : paper::diagonal_step(rate(x, y), rate(i, j), rate(x, j), rate(i, y));
        if (there == field::kNoWay || there + step >= cost[static_cast<std::size_t>(c)]) continue;
        cost[static_cast<std::size_t>(c)] = there + step, any = true;
      }
    }
  }
  int differ = 0;
  for (std::int32_t c = 0; c < rig.grid.cells(); ++c)
    differ += rate(c % 64, c / 64) != 0 && field.cost(c % 64, c / 64) != cost[static_cast<std::size_t>(c)] ? 1 : 0;
  CHECK(differ == 0);
}
