#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "planner/cell/cell.h"

namespace jaywalk::field {

/// A square of cells, numbered row by row from the lowest y.
struct Grid {
  std::int32_t side = 0;

  [[nodiscard]] JAYWALK_CELL std::int32_t cells() const { return side * side; }
  [[nodiscard]] JAYWALK_CELL std::int32_t at(std::int32_t i, std::int32_t j) const { return j * side + i; }
  [[nodiscard]] JAYWALK_CELL bool holds(std::int32_t i, std::int32_t j) const {
    return i >= 0 && j >= 0 && i < side && j < side;
  }
};

inline constexpr std::int32_t kNoCell = -1;

/// Cells in reach of a given one through free cells.
class Flood {
 public:
  explicit Flood(std::int32_t max_cells)
      : filled_(static_cast<std::size_t>(max_cells)), queue_(static_cast<std::size_t>(max_cells)) {}

  /// Fills from `start` over cells for which is_free(cell), along rows and columns, and along diagonals where so said.
  template <class IsFree>
  void fill(Grid grid, std::int32_t start, bool diagonals, const IsFree& is_free) noexcept {
    std::fill_n(filled_.begin(), grid.cells(), std::uint8_t{0});
    touches_border_ = false;
    std::size_t head = 0, tail = 0;
    const auto enter = [&](std::int32_t i, std::int32_t j) {
      if (!grid.holds(i, j)) return void(touches_border_ = true);
      const std::int32_t c = grid.at(i, j);
      if (holds(c) || !is_free(c)) return;
      filled_[static_cast<std::size_t>(c)] = 1;
      queue_[tail++] = c;
    };
    for (enter(start % grid.side, start / grid.side); head < tail; ++head) {
      const std::int32_t i = queue_[head] % grid.side, j = queue_[head] / grid.side;
      enter(i - 1, j), enter(i + 1, j), enter(i, j - 1), enter(i, j + 1);
      if (diagonals) enter(i - 1, j - 1), enter(i + 1, j - 1), enter(i - 1, j + 1), enter(i + 1, j + 1);
    }
  }
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
