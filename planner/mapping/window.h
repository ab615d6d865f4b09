#pragma once
// Grid of the planner, and the window of the world that it lies in.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "hal/types/geometry.h"
#include "planner/cell/cell.h"
#include "planner/mapping/evidence_map.h"

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

/// The square of the world that is planned on. Anchored: it stays where it is while that serves, and
/// moves by whole blocks, so that cells are the same cells from tick to tick.
struct Window {
  CellIndex low;  ///< world index of its lowest cell
  std::int32_t side = 0;
  double cell_m = 0.1;

  bool operator==(const Window&) const = default;
  [[nodiscard]] Grid grid() const { return {side}; }
  /// Cell of a point, counted from `low`; not necessarily inside.
  [[nodiscard]] CellIndex cell_at(Vec2 p_in_map) const;
  /// A point in cells from the window's low corner: the centre of cell (0, 0) is (0.5, 0.5).
  [[nodiscard]] Vec2 in_cells(Vec2 p_in_map) const;
  [[nodiscard]] Vec2 in_map(Vec2 p_in_cells) const {
    return {(p_in_cells.x + low.i) * cell_m, (p_in_cells.y + low.j) * cell_m};
  }
  /// Whether a point lies inside with `margin` cells to spare.
  [[nodiscard]] bool holds(Vec2 p_in_map, std::int32_t margin) const {
    const CellIndex c = cell_at(p_in_map);
    return c.i >= margin && c.j >= margin && c.i < side - margin && c.j < side - margin;
  }
};

inline constexpr std::int32_t kWindowBlock = 16;  ///< cells by which a window moves
/// Room (cells) round the box of robot and goal that a window of that size needs: 1.5 m at 0.1 m.
inline constexpr std::int32_t kWindowMargin = 15;
/// A window that does not hold the goal moves on when the robot is this near its border: 3 m.
inline constexpr std::int32_t kWindowRollMargin = 30;

/// The window for a robot and a goal: `now` while it serves, else one between the two where they both
/// fit, else one that holds the robot and looks towards the goal.
[[nodiscard]] Window placed(const Window& now, Vec2 robot_in_map, Vec2 goal_in_map);

/// Submissions in a row, a second at 15 Hz, that walls alone keep from the goal before the window doubles: a doorway
/// that noise closes for a scan must not quadruple the work for good.
inline constexpr int kPatience = 15;

/// A planner's window: it follows robot and goal, and doubles where a way round may lie outside it.
class GrowingWindow {
 public:
  GrowingWindow(const Window& first, std::int32_t max_side) : now_(first), max_side_(max_side) {}

  [[nodiscard]] const Window& now() const noexcept { return now_; }
  void place(Vec2 robot_in_map, Vec2 goal_in_map) noexcept { now_ = placed(now_, robot_in_map, goal_in_map); }
  [[nodiscard]] bool can_grow() const noexcept { return 2 * now_.side <= max_side_; }
  /// After each plan: whether walls alone keep the robot, which can leave the window, from a goal inside. Doubles it
  /// about its middle when that was so kPatience times in a row.
  void note_walled_off(bool walled_off) noexcept;

 private:
  Window now_;
  std::int32_t max_side_;
  int walled_off_ = 0;  ///< plans in a row
};

/// Where a goal outside projects onto the border along its line from the robot, in cells; a goal inside as it is.
[[nodiscard]] CellIndex projected_goal(const Window& window, Vec2 robot_in_map, Vec2 goal_in_map);

}  // namespace jaywalk::field
