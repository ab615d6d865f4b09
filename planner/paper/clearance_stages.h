#pragma once
// Exact Euclidean distance of every cell to the nearest one that is not free: columns first, then rows.
#include <cmath>

#include "planner/cell/clearance.h"
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
    std::int32_t *column = envelope + row, *begin = stretch + row, top = 0;
    column[0] = begin[0] = 0;
    for (std::int32_t u = 1; u < grid.side; ++u) {
      while (top >= 0 && cell::squared_distance(begin[top], column[top], g[column[top]]) >
                             cell::squared_distance(begin[top], u, g[u])) {
        --top;
      }
      const std::int32_t from = top < 0 ? 0 : 1 + cell::last_nearer(column[top], g[column[top]], u, g[u]);
      if (from >= grid.side) continue;
      ++top;
      column[top] = u;
      begin[top] = from;
    }
    for (std::int32_t i = grid.side - 1; i >= 0; --i) {
      const std::int32_t squared = cell::squared_distance(i, column[top], g[column[top]]);
      if (i == begin[top]) --top;
      clearance[row + i] = paper::clearance(squared, inflation, cells_to_border(i, j, width, height));
    }
  }
};

}  // namespace jaywalk::paper
