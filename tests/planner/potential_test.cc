#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/field/random_maps.h"
#include "planner/mapping/window.h"
#include "planner/paper/map_field.h"
#include "planner/paper/path.h"
#include "tests/planner/field_rig.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// psi of the harmonic function in double precision: Gauss-Seidel on u = 1 - phi from 0 until nothing moves.
std::vector<double> harmonic_reference(const paper::Grid& grid, const float* clearance, std::int32_t goal) {
  std::vector<double> u(static_cast<std::size_t>(grid.cells()), 0.0);
  const auto at = [&](std::int32_t i, std::int32_t j) {
    return grid.holds(i, j) ? u[static_cast<std::size_t>(grid.at(i, j))] : 0.0;
  };
  u[static_cast<std::size_t>(goal)] = 1.0;
  for (double change = 1.0; change > 1e-13;) {
    change = 0.0;
    for (std::int32_t c = 0; c < grid.cells(); ++c) {
      if (clearance[c] <= 0.0F || c == goal) continue;
      const std::int32_t i = c % grid.side, j = c / grid.side;
      const double mean = (at(i + 1, j) + at(i - 1, j) + at(i, j + 1) + at(i, j - 1)) / 4.0;
      double& here = u[static_cast<std::size_t>(c)];
      if (mean > 0.0) change = std::max(change, std::fabs(mean - here) / mean);
      here = mean;
    }
  }
  for (double& value : u) value = -std::log(value);
  return u;
}

}  // namespace

TEST_CASE("the solved potential is the harmonic function to a thousandth, the exact field to the last digits") {
  FieldRig<> rig(64);
  rig.load(rooms(), 1.0F, rig.grid.at(55, 50));
  rig.solve_fully();
  const std::vector<double> exact = rig.exact();
  const std::vector<double> swept = harmonic_reference(rig.grid, rig.arrays().clearance, rig.goal);
  int joined = 0;
  for (std::int32_t c = 0; c < rig.grid.cells(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    CHECK((exact[k] == swept[k] || std::fabs(exact[k] - swept[k]) < 1e-9));
    if (!cell::is_joined(rig.psi()[c])) continue;
    ++joined;
    CHECK(std::fabs(static_cast<double>(rig.psi()[c]) - swept[k]) < 1e-3);
  }
  CHECK(joined > 2000);
}

TEST_CASE("the exact field is exact however small u gets") {
  // A row of cells between walls: u falls by e^-k a cell with 2 cosh k = 4, beyond what a double can hold at 540 cells.
  std::vector<std::uint8_t> free(1024 * 1024, 0);
  std::fill_n(free.begin() + 5 * 1024, 1024, 1);
  const std::vector<double> line = paper::exact_psi({1024}, free.data(), 5 * 1024);
  CHECK(line[5 * 1024 + 600] == Approx(600.0 * std::acosh(2.0)).epsilon(1e-12));
}

TEST_CASE("certified means that descent arrives from every joined cell, on every map") {
  FieldRig<> rig(256);
  std::vector<std::uint8_t> seen(256 * 256);
  for (const TestMap& map : {open_room(), office(), serpentine(15), serpentine(10), clutter(4), speckle(4)}) {
    rig.load(map, 3.0F, rig.grid.at(12, map.name[1] == 'e' ? 6 : 12));
    const paper::FieldQuality cold = rig.solve();
    CHECK(cold.certified);
    CHECK(cold.cycles >= paper::cold_cycles(rig.grid).least);
    CHECK(cold.cycles <= paper::cold_cycles(rig.grid).most);
    CHECK(paper::share_arriving(rig.grid, rig.psi(), rig.arrays().index, rig.goal, seen.data()) == 1.0F);
    const paper::FieldQuality warm = rig.solve(paper::From::kLast);
    CHECK(warm.certified);
    CHECK(warm.cycles <= paper::kWarmCycles.most);
  }
}

TEST_CASE("solved cold, 99.9 percent of cells or more pick the exact field's best neighbour, in corridors too") {
  FieldRig<> rig(256);
  for (const TestMap& map : {open_room(), office(), clutter(1), speckle(1), serpentine(15), serpentine(10)}) {
    rig.load(map, 3.0F, map.name[1] == 'e' ? rig.grid.at(12, 6) : rig.grid.at(243, 243));
    REQUIRE(rig.solve().certified);
    const double best = rig.share_of_best();
    std::printf("%s: %.3f %% pick the best neighbour\n", map.name.c_str(), 100.0 * best);
    CHECK(best >= 0.999);
  }
}

TEST_CASE("in caves with ragged passages 99.9 percent or more pick the best neighbour too") {
  FieldRig<> rig(256);
  for (const std::uint64_t seed : {262U, 263U}) {  // four cycles with fewer sweeps left 99.89 and 99.88
    MapRandom random(7 * seed + static_cast<std::uint64_t>(MapKind::kCave));
    TestMap map("cave", 256);
    map.wall = random_map(MapKind::kCave, 256, random).wall;
    const auto inflation = static_cast<float>(random.below(5));
    const std::int32_t i = random.below(256), j = random.below(256);
    rig.load(map, inflation, 0);
    const float* clearance = rig.arrays().clearance;
    const auto is_free = [&](std::int32_t c) { return clearance[c] > 0.0F; };
    rig.load(map, inflation, field::nearest_cell(rig.grid, i, j, 256, is_free));
    const paper::FieldQuality cold = rig.solve();
    CHECK(cold.certified);
    CHECK(cold.joined > 1000);
    CHECK(rig.share_of_best() >= 0.999);
  }
}

TEST_CASE("a row of blocks speaks for all cells but those behind a wall inside a block") {
  // Two blocks over eight, of which seven have an equation. The first block speaks for all four of its own. The second
  // lies across a wall: of its three it speaks for those in the lower row, bits 0 and 1.
  const std::vector<float> diagonal{1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 0.0F};
  const std::vector<std::int32_t> ties{15, 3};
  paper::Counted spoken;
  paper::SpokenOfRow{2, diagonal.data(), ties.data(), &spoken}(0);
  CHECK(spoken.cells == 6);
  CHECK(spoken.joined == 7);
}

TEST_CASE(
    "in six kilometres of corridor of 1.5 m a solution stays certified when nothing has changed, in two cycles or "
    "less") {
  FieldRig<> rig(1024);
  TestMap map("serpentine", 1024);
  for (std::int32_t j = 16, turn = 0; j + 15 < 1023; j += 17, ++turn) {  // 60 corridors
    map.box(0, j, 1024, j + 2), map.box(turn % 2 == 0 ? 1008 : 1, j, turn % 2 == 0 ? 1023 : 16, j + 2, 0);
  }
  rig.load(map, 3.0F, rig.grid.at(12, 6));
  REQUIRE(rig.solve().certified);
  for (int tick = 0; tick < 4; ++tick) {
    const paper::FieldQuality warm = rig.solve(paper::From::kLast);
    CHECK(warm.certified);
    CHECK(warm.cycles <= paper::kWarmCycles.most);
    CHECK(warm.joined > 400000);
  }
}

TEST_CASE("free cells at the window's border are as right as others: nothing is coupled across it") {
  FieldRig<> rig(64);
  TestMap map("open to its border", 64);
  map.box(0, 0, 64, 64, 0), map.box(30, 20, 60, 21);
  rig.load(map, 0.0F, rig.grid.at(20, 30));
  rig.solve_fully();
  const std::vector<double> exact = rig.exact();
  double worst = 0.0;
  for (std::int32_t j = 0; j < 64; ++j) {
    for (const std::int32_t c : {rig.grid.at(0, j), rig.grid.at(63, j), rig.grid.at(j, 0), rig.grid.at(j, 63)}) {
      worst = std::max(worst, std::fabs(static_cast<double>(rig.psi()[c]) - exact[static_cast<std::size_t>(c)]));
    }
  }
  CHECK(worst < 1e-3);
}

TEST_CASE("a pit breaks the certificate and is counted, and lowers the reach") {
  FieldRig<> rig(64);
  rig.load(rooms(), 1.0F, rig.grid.at(55, 50));
  (void)rig.solve();
  rig.psi()[rig.grid.at(10, 10)] -= 5.0F;
  std::vector<paper::Counted> pits(64);
  rig.executor.for_each_cell(64, 1, paper::PitsOfRow{rig.grid, rig.goal, rig.psi(), pits.data()});
  CHECK(pits[10].cells == 1);
  rig.executor.for_each_cell(64, 64, paper::IndexOfEachCell{rig.grid, rig.psi(), rig.arrays().index});
  std::vector<std::uint8_t> seen(64 * 64);
  const float reach = paper::share_arriving(rig.grid, rig.psi(), rig.arrays().index, rig.goal, seen.data());
  CHECK(reach < 1.0F);
  CHECK(reach > 0.0F);
}

TEST_CASE("what rounding has levelled is lifted until it descends again, and nothing else moves") {
  FieldRig<> rig(64);
  rig.load(rooms(), 1.0F, rig.grid.at(55, 50));
  (void)rig.solve();
  const std::vector<float> before(rig.psi(), rig.psi() + rig.grid.cells());
  const std::int32_t c = rig.grid.at(10, 10);
  const float lowest = std::min({rig.psi()[c - 1], rig.psi()[c + 1], rig.psi()[c - 64], rig.psi()[c + 64]});
  rig.psi()[c] = lowest;
  for (const std::int32_t colour : {0, 1})
    rig.executor.for_each_cell(64, 64, paper::LiftPits{rig.grid, colour, rig.goal, rig.psi()});
  CHECK(rig.psi()[c] == std::nextafter(lowest, 1e9F));
  for (std::int32_t n = 0; n < rig.grid.cells(); ++n) {
    if (n != c && cell::is_joined(before[static_cast<std::size_t>(n)])) {
      CHECK(rig.psi()[n] == before[static_cast<std::size_t>(n)]);
    }
  }
}
