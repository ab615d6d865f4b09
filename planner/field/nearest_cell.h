#pragma once
#include <vector>

#include "planner/mapping/grid.h"

namespace jaywalk::field {

inline constexpr std::int32_t kNoCell = -1;

/// Cells in reach of a given one through free cells (clearance above 0), four neighbours a cell.
class Flood {
 public:
  explicit Flood(std::int32_t max_cells);
  /// Fills from `start`, a free cell.
  void fill(Grid grid, const float* clearance, std::int32_t start) noexcept;
  [[nodiscard]] bool holds(std::int32_t cell) const noexcept { return filled_[static_cast<std::size_t>(cell)] != 0; }
  /// Whether a cell on the grid's border was reached: outside there may be more.
  [[nodiscard]] bool touches_border() const noexcept { return touches_border_; }

 private:
  std::vector<std::uint8_t> filled_;
  std::vector<std::int32_t> queue_;
  bool touches_border_ = false;
};

/// The cell nearest (i, j) within `radius` cells for which wanted(cell); kNoCell without one. Of equally
/// near ones the first by row, then column. Looks at rings from the inside out.
template <class Wanted>
[[nodiscard]] std::int32_t nearest_cell(Grid grid, std::int32_t i, std::int32_t j, std::int32_t radius,
                                        const Wanted& wanted) noexcept {
  std::int32_t best = kNoCell, best_squared = radius * radius + 1;
  const auto look = [&](std::int32_t x, std::int32_t y) {
    const std::int32_t squared = (x - i) * (x - i) + (y - j) * (y - j);
    if (squared > best_squared || !grid.holds(x, y)) return;
    if ((squared == best_squared && grid.at(x, y) >= best) || !wanted(grid.at(x, y))) return;
    best = grid.at(x, y);
    best_squared = squared;
  };
  for (std::int32_t ring = 0; ring <= radius && ring * ring <= best_squared; ++ring) {
    for (std::int32_t k = -ring; k <= ring; ++k) {
      look(i + k, j - ring);
      look(i + k, j + ring);
      look(i - ring, j + k);
      look(i + ring, j + k);
    }
  }
  return best;
}

}  // namespace jaywalk::field
