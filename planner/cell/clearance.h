#pragma once
#include <bit>
#include <cmath>

#include "planner/cell/cell.h"

namespace jaywalk::cell {

// Exact Euclidean distance transform in integers, separable as Meijster, Roerdink and Hesselink
// (2000) have it: along a row, cell u sees the nearest obstacle of column i at squared distance
// (u - i)^2 + g_i^2, where g_i is that column's distance to its own nearest obstacle.

/// Numbers of the lowest and the highest bit that is set, 0 to 31; one is.
JAYWALK_CELL std::int32_t lowest_bit(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __ffs(static_cast<int>(bits)) - 1;
#else
  return std::countr_zero(bits);
#endif
}
JAYWALK_CELL std::int32_t highest_bit(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return 31 - __clz(static_cast<int>(bits));
#else
  return 31 - std::countl_zero(bits);
#endif
}

/// Squared distance from column `u` to the nearest obstacle of column `i`, `g` rows away.
JAYWALK_CELL std::int32_t squared_distance(std::int32_t u, std::int32_t i, std::int32_t g) {
  return (u - i) * (u - i) + g * g;
}

/// Last column at which column `i` is still no farther than column `u` > i.
JAYWALK_CELL std::int32_t last_nearer(std::int32_t i, std::int32_t gi, std::int32_t u, std::int32_t gu) {
  return (u * u - i * i + gu * gu - gi * gi) / (2 * (u - i));
}

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

}  // namespace jaywalk::cell
