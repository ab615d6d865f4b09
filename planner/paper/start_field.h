#pragma once
// Clearance of every cell, and the start field: shortest ways to the goal in integer costs.
#include <cmath>
#include <vector>

#include "planner/cell/cell.h"
#include "planner/cost_to_go/cell_graph.h"
#include "planner/cost_to_go/shortest.h"
#include "planner/paper/executor.h"

namespace jaywalk::paper {
/// Cells between a cell and the nearest one that is not free, at least 1; 0 when the cell itself is
/// not free, that is within `inflation` cells of an obstacle or outside the window. `to_border` counts cells to the
/// first one outside (0 or less: it is outside itself), which is not free but does not inflate.
JAYWALK_CELL float clearance(std::int32_t squared, float inflation, std::int32_t to_border) {
  const auto d2 = static_cast<float>(squared);
  if (d2 <= inflation * inflation || to_border <= 0) return 0.0F;
  const float to_obstacle = std::sqrt(d2) - inflation;
  const auto border = static_cast<float>(to_border);
  const float nearest = to_obstacle < border ? to_obstacle : border;
  return nearest > 1.0F ? nearest : 1.0F;
}

/// Width in cells of the passage that a cell lies in, from its own clearance and, for either axis, that of the better
/// of its two neighbours there. Beside the middle line some neighbour is farther from walls: own + that one's counts
/// both sides, 2 + 3 = 5 in a passage of 1 2 3 2 1. On it the neighbours across tell 1 2 3 2 1 (3 + 2 = 5) from 1 2 2 1
/// (2 + 2 = 4); those along the passage are as far from walls as the cell itself.
JAYWALK_CELL float passage_width(float own, float best_along_x, float best_along_y) {
  const float better = best_along_x > best_along_y ? best_along_x : best_along_y;
  const float worse = best_along_x > best_along_y ? best_along_y : best_along_x;
  return own + (better > own ? better : worse);
}

/// Cells to the first one outside; 0 or less where the cell is outside itself.
JAYWALK_CELL std::int32_t cells_to_border(std::int32_t i, std::int32_t j, std::int32_t width, std::int32_t height) {
  const std::int32_t x = i < width - 1 - i ? i : width - 1 - i;
  const std::int32_t y = j < height - 1 - j ? j : height - 1 - j;
  return (x < y ? x : y) + 1;
}

/// Rows from each cell of a strip of columns to the nearest occupied cell of its column.
struct NearestInColumns {
  static constexpr std::int32_t kColumns = 16;  ///< of a strip: a line of a cache; divides every side
  Grid grid;
  const std::uint8_t* occupants;
  std::uint8_t wanted;  ///< the occupants that count
  std::int32_t* rows_away;

  JAYWALK_CELL void operator()(std::int32_t strip) const {
    const std::int32_t none = 2 * grid.side, last = grid.side - 1;
    for (std::int32_t j = 0; j <= last; ++j) {
      for (std::int32_t c = grid.at(strip * kColumns, j), end = c + kColumns; c < end; ++c) {
        const std::int32_t below = j > 0 ? rows_away[c - grid.side] : none;
        const std::int32_t away = below < none ? below + 1 : none;
        rows_away[c] = (occupants[c] & wanted) != 0 ? 0 : away;
      }
    }
    for (std::int32_t j = last - 1; j >= 0; --j) {
      for (std::int32_t c = grid.at(strip * kColumns, j), end = c + kColumns; c < end; ++c) {
        const std::int32_t here = rows_away[c], away = rows_away[c + grid.side] + 1;
        rows_away[c] = away < here ? away : here;
      }
    }
  }
};

/// The lower envelope of a row's columns, then each cell's clearance; 0 where it is not free.
struct ClearanceOfRow {
  Grid grid;
  std::int32_t width, height;  ///< cells of the grid that count; what lies beyond is outside
  const std::int32_t* rows_away;
  float inflation;                   ///< cells
  std::int32_t *envelope, *stretch;  ///< columns of the lower envelope; first cell of each one's stretch
  float* clearance;

  JAYWALK_CELL void operator()(std::int32_t j) const {
    const std::int32_t row = grid.at(0, j);
    const std::int32_t* g = rows_away + row;
    std::int32_t *column = envelope + row, *begin = stretch + row;
    const auto away = [g](std::int32_t i) { return g[i]; };
    std::int32_t top = cell::lower_envelope(0, grid.side - 1, away, column, begin) - 1;
    for (std::int32_t i = grid.side - 1; i >= 0; --i) {
      const std::int32_t squared = cell::squared_distance(i, column[top], g[column[top]]);
      if (i == begin[top]) --top;
      clearance[row + i] = paper::clearance(squared, inflation, cells_to_border(i, j, width, height));
    }
  }
};

// Cost of a step of the start field, from half the costs (`rate`) of the cells that it touches. Integers, so that
// the dearest and the cheapest way are the same whatever the order.

/// Between two cells side by side.
JAYWALK_CELL std::uint32_t straight_step(std::uint32_t from, std::uint32_t to) { return from + to; }

/// Between two cells at a corner; `a` and `b` are the free ones beside both. Dearer than straight ahead by a quarter in
/// wide rooms and by more in narrow passages, where turning costs more: 5/4 w + w^2/16384, w a straight step of 4096 to
/// a unit of -ln u. Measured with exact_psi; so that estimates are rather too high than too low, since cycles correct
/// upwards by a factor of eight at most. Never so cheap that neither `a` nor `b` is lower than where the step leads,
/// from either end: descent by four neighbours arrives too.
JAYWALK_CELL std::uint32_t diagonal_step(std::uint32_t from, std::uint32_t to, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t straight = from + to, wanted = straight + straight / 4 + straight * straight / 16384;
  const std::uint32_t least = (a < b ? a : b) + (from > to ? from : to) + 1;
  return wanted > least ? wanted : least;
}

/// Cost units per unit of psi.
inline constexpr float kCostsPerPsi = 4096.0F;
/// Nothing is sought beyond this cost, a million units of psi: 800,000 cells of a passage one cell wide. What lies
/// there counts as out of reach. (The dearest step, a diagonal one of w = 2 x 2697, costs 8,518.)
inline constexpr std::uint32_t kFarthest = field::kNoWay - 16384;

/// Half a step's cost by passage width in steps of a quarter cell: half of acosh(2 - cos(pi/(w+1))),
/// the rate at which a harmonic function decays along a passage w cells wide.
[[nodiscard]] std::vector<std::uint16_t> rate_table(std::int32_t max_side);

/// Cells with the steps to eight neighbours in place of a CellGraph's; a rate is half of a step's cost. A diagonal step
/// passes between two free cells.
struct StartGraph : field::CellGraph {
  static constexpr std::uint32_t kSpan = 1024;
  using CellGraph::CellGraph;
  [[nodiscard]] static std::uint32_t limit() noexcept { return kFarthest; }
  template <class May, class Visit>
  void for_each_step(std::int32_t n, const May& may, const Visit& visit) const noexcept;
};

/// The start field of one goal: an estimate of psi that descends to the goal from everywhere. A step costs what -ln u
/// would rise by in a passage as wide as the one it is in. Memory for grids up to `max_side` cells in the constructor.
class StartField {
 public:
  explicit StartField(std::int32_t max_side);
  /// Fills `psi` by rows: cell::kNotFree where there is no clearance, cell::kUnreachable where there is no way. `goal`:
  /// a free cell. False where the queue was full: the field is then none.
  [[nodiscard]] bool settle(Grid grid, std::int32_t goal, const float* clearance, float* psi) noexcept;
  /// Half of a step's cost in a cell, and a cell's cost; of the last field.
  [[nodiscard]] std::uint32_t rate(std::int32_t i, std::int32_t j) const noexcept {
    return graph_.rate(graph_.at(i, j));
  }
  [[nodiscard]] std::uint32_t cost(std::int32_t i, std::int32_t j) const noexcept {
    return graph_.cost(graph_.at(i, j));
  }

 private:
  std::vector<std::uint16_t> table_;
  StartGraph graph_;
  field::Shortest queue_;
};

}  // namespace jaywalk::paper
