#pragma once
#include <algorithm>
#include <utility>

#include "planner/paper/map_field.h"
#include "planner/paper/pass.h"
#include "planner/paper/path.h"

namespace jaywalk::paper {
/// Side of the grid that holds a map.
inline std::int32_t side_for(const CellMap& map) {
  std::int32_t side = 64;
  while (side < std::max(map.width, map.height)) side *= 2;
  return side;
}

/// A MapField on any executor, which it owns.
template <class Executor>
class MapFieldOn final : public MapField {
 public:
  MapFieldOn(CellMap map, std::unique_ptr<Executor> executor)
      : map_(std::move(map)), executor_(std::move(executor)), grid_{side_for(map_)}, pass_(*executor_, grid_.side) {
    MapFieldOn::inflate(0.0F);
  }

  void inflate(float inflation) noexcept override {
    inflation_ = inflation;
    for (std::int32_t j = 0; j < map_.height; ++j) {
      const auto row = map_.wall.begin() + static_cast<std::ptrdiff_t>(j) * map_.width;
      for (std::int32_t i = 0; i < map_.width; ++i)
        pass_.shown().occupants[grid_.at(i, j)] = row[i] != 0 ? std::uint8_t{kWall} : std::uint8_t{0};
    }
    (void)pass_.clear(grid_, map_.width, map_.height, inflation, kWall);
  }

  [[nodiscard]] bool nearest_free(CellIndex& at, std::int32_t radius) const noexcept override {
    const float* clearance = pass_.shown().clearance;
    const std::int32_t found =
        nearest_cell(grid_, at.i, at.j, radius, [clearance](std::int32_t c) { return clearance[c] > 0.0F; });
    if (found == kNoCell) return false;
    at = {found % grid_.side, found / grid_.side};
    return true;
  }

  MapQuality solve_cold(CellIndex goal) noexcept override {
    inflate(inflation_);
    return solve(goal, From::kNothing);
  }
  MapQuality solve_warm(CellIndex goal) noexcept override { return solve(goal, From::kLast); }
  MapQuality solve_start(CellIndex goal) noexcept override { return solve(goal, From::kStartOnly); }

  [[nodiscard]] float reach(CellIndex goal) noexcept override {
    std::vector<std::uint8_t> seen(static_cast<std::size_t>(grid_.cells()));
    return share_arriving(grid_, pass_.shown().psi, pass_.shown().index, grid_.at(goal.i, goal.j), seen.data());
  }

  [[nodiscard]] std::optional<double> best_neighbours(CellIndex goal, double most) const override {
    std::vector<std::uint8_t> free(static_cast<std::size_t>(grid_.cells()));
    for (std::size_t c = 0; c < free.size(); ++c) free[c] = pass_.shown().clearance[c] > 0.0F ? 1 : 0;
    const std::int32_t at = grid_.at(goal.i, goal.j);
    const std::vector<double> exact = exact_psi(grid_, free.data(), at, most);
    if (exact.empty()) return std::nullopt;
    return share_of_best(grid_, pass_.shown().psi, exact, at);
  }

  [[nodiscard]] float psi(std::int32_t i, std::int32_t j) const noexcept override {
    return pass_.shown().psi[grid_.at(i, j)];
  }
  [[nodiscard]] const char* backend() const noexcept override { return executor_->name(); }
  [[nodiscard]] double device_ms() const noexcept override { return executor_->took_ms(); }

 private:
  MapQuality solve(CellIndex goal, From from) noexcept {
    const std::int32_t c = grid_.at(goal.i, goal.j);
    const FieldQuality q = pass_.solve(grid_, c, from);
    if (!q.done) return {};  // what a device that failed has left is no field to follow
    return {q.certified, q.certified ? 1.0F : reach(goal), q.joined, q.cycles};
  }

  CellMap map_;
  float inflation_ = 0.0F;
  std::unique_ptr<Executor> executor_;
  Grid grid_;
  Pass<Executor> pass_;
};

}  // namespace jaywalk::paper
