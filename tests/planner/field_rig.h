#pragma once
// The pass on a test map, without window or planner.
#include <memory>
#include <vector>

#include "planner/paper/executor.h"
#include "planner/paper/map_field.h"
#include "planner/paper/pass.h"
#include "tests/planner/test_maps.h"

namespace jaywalk::test {

template <class Executor = paper::SerialExecutor>
struct FieldRig {
  Executor executor;
  paper::Pass<Executor> pass;
  paper::Grid grid;
  std::int32_t goal = 0;

  explicit FieldRig(std::int32_t side) : pass(executor, side), grid{side} {}

  [[nodiscard]] const paper::FieldArrays& arrays() const { return pass.shown(); }
  [[nodiscard]] float* psi() const { return arrays().psi; }

  /// Occupants, clearance with `inflation` cells, start field.
  void load(const TestMap& map, float inflation, std::int32_t to) {
    goal = to;
    for (std::size_t c = 0; c < map.wall.size(); ++c) arrays().occupants[c] = map.wall[c];
    (void)pass.clear(grid, inflation, paper::kWall);
    (void)pass.start(grid, goal);
  }

  paper::FieldQuality solve(paper::From from = paper::From::kNothing) { return pass.solve(grid, goal, from); }
  /// From nothing, and then three times from the last.
  void solve_fully() {
    (void)solve();
    for (int k = 0; k < 3; ++k) (void)solve(paper::From::kLast);
  }
  [[nodiscard]] double share_of_best() const { return paper::share_of_best(grid, psi(), exact(), goal); }
  /// The exact field of the free cells.
  [[nodiscard]] std::vector<double> exact() const {
    std::vector<std::uint8_t> free(static_cast<std::size_t>(grid.cells()));
    for (std::size_t c = 0; c < free.size(); ++c) free[c] = arrays().clearance[c] > 0.0F ? 1 : 0;
    return paper::exact_psi(grid, free.data(), goal);
  }
};

}  // namespace jaywalk::test
