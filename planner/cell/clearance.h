#pragma once
#include "planner/cell/cell.h"

namespace jaywalk::cell {

// Exact Euclidean distance transform in integers, separable as Meijster, Roerdink and Hesselink
// (2000) have it: along a row, cell u sees the nearest obstacle of column i at squared distance
// (u - i)^2 + g_i^2, where g_i is that column's distance to its own nearest obstacle.

/// Squared distance from column `u` to the nearest obstacle of column `i`, `g` rows away.
JAYWALK_CELL std::int32_t squared_distance(std::int32_t u, std::int32_t i, std::int32_t g) {
  return (u - i) * (u - i) + g * g;
}

/// Last column at which column `i` is still no farther than column `u` > i.
JAYWALK_CELL std::int32_t last_nearer(std::int32_t i, std::int32_t gi, std::int32_t u, std::int32_t gu) {
  return (u * u - i * i + gu * gu - gi * gi) / (2 * (u - i));
}

}  // namespace jaywalk::cell
