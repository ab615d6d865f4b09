#pragma once
// Cell functions take values and return a value. The same source gives the same bits on the processor and on the
// graphics card: of + - x / sqrt, comparisons, integers and the polynomials of exp_log.h alone.
#ifdef __CUDACC__
#define JAYWALK_CELL __host__ __device__ inline
#define JAYWALK_ANYWHERE __host__ __device__ inline
#else
#define JAYWALK_ANYWHERE inline                     // for functions too long to be put into each of their callers
#define JAYWALK_CELL [[gnu::always_inline]] inline  // a stage that is called cannot go four cells at a time
#endif
#include <cstdint>
#include <limits>

namespace jaywalk::cell {

/// psi of a free cell from which the goal cannot be reached.
inline constexpr float kUnreachable = std::numeric_limits<float>::infinity();
/// psi of a cell that is not free.
inline constexpr float kNotFree = std::numeric_limits<float>::quiet_NaN();

inline constexpr float kLargest = std::numeric_limits<float>::max();

/// Whether a cell with this psi is free and joined to the goal (false for NaN and infinity).
JAYWALK_CELL bool is_joined(float psi) { return psi <= kLargest; }

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
