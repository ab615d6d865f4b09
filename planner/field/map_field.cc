#include "planner/field/map_field.h"

#include <algorithm>
#include <utility>

#include "planner/field/executor.h"
#include "planner/field/nearest_cell.h"
#include "planner/field/pass.h"
#include "planner/field/path.h"

namespace jaywalk::field {
namespace {

constexpr std::int32_t kLeastSide = 64;

std::int32_t side_for(const CellMap& map) {
  std::int32_t side = kLeastSide;
  while (side < std::max(map.width, map.height)) side *= 2;
  return side;
}

}  // namespace

struct MapField::Solver {
  SerialExecutor executor;
  Grid grid;
  Pass<SerialExecutor> pass;
  float* psi;

  explicit Solver(std::int32_t side) : grid{side}, pass(executor, side), psi(take_rows<float>(executor, side)) {}
};

MapField::MapField(CellMap map) : map_(std::move(map)), solver_(std::make_unique<Solver>(side_for(map_))) {
  inflate(0.0F);
}

MapField::~MapField() = default;

void MapField::inflate(float inflation) noexcept {
  const FieldArrays& a = solver_->pass.arrays();
  const Grid grid = solver_->grid;
  inflation_ = inflation;
  for (std::int32_t j = 0; j < map_.height; ++j) {
    const auto row = map_.wall.begin() + static_cast<std::ptrdiff_t>(j) * map_.width;
    for (std::int32_t i = 0; i < map_.width; ++i)
      a.occupants[grid.at(i, j)] = row[i] != 0 ? std::uint8_t{kWall} : std::uint8_t{0};
  }
  solver_->pass.forget();
  (void)solver_->pass.clear(grid, inflation, kWall);
  for (std::int32_t j = 0; j < grid.side; ++j) {
    const std::int32_t from = j < map_.height ? map_.width : 0;
    std::fill(a.clearance + grid.at(from, j), a.clearance + grid.at(0, j + 1), 0.0F);
  }
}

bool MapField::nearest_free(CellIndex& at, std::int32_t radius) const noexcept {
  const float* clearance = solver_->pass.arrays().clearance;
  const Grid grid = solver_->grid;
  const std::int32_t found =
      nearest_cell(grid, at.i, at.j, radius, [clearance](std::int32_t c) { return clearance[c] > 0.0F; });
  if (found == kNoCell) return false;
  at = {found % grid.side, found / grid.side};
  return true;
}

MapQuality MapField::solve_cold(CellIndex goal) noexcept {
  inflate(inflation_);
  const Grid grid = solver_->grid;
  const std::int32_t c = grid.at(goal.i, goal.j);
  (void)solver_->pass.start(grid, c);
  const FieldQuality q = solver_->pass.solve(grid, c, false, solver_->psi);
  return {q.certified, q.certified ? 1.0F : reach(goal), q.joined, q.cycles};
}

MapQuality MapField::solve_warm(CellIndex goal) noexcept {
  const Grid grid = solver_->grid;
  const std::int32_t c = grid.at(goal.i, goal.j);
  (void)solver_->pass.clear(grid, inflation_, kWall);
  (void)solver_->pass.start(grid, c);
  const FieldQuality q = solver_->pass.solve(grid, c, true, solver_->psi);
  return {q.certified, q.certified ? 1.0F : reach(goal), q.joined, q.cycles};
}

float MapField::reach(CellIndex goal) noexcept {
  const Grid grid = solver_->grid;
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(grid.cells()));
  return share_arriving(grid, solver_->psi, solver_->pass.arrays().index, grid.at(goal.i, goal.j), seen.data());
}

float MapField::psi(std::int32_t i, std::int32_t j) const noexcept { return solver_->psi[solver_->grid.at(i, j)]; }

}  // namespace jaywalk::field
