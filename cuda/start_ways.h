#pragma once
#include "cuda/settle_tiles.h"
#include "planner/field/start_field.h"

namespace jaywalk {

/// Everything far but the goal.
struct FarFromGoal {
  std::int32_t goal;
  std::uint32_t* cost;

  JAYWALK_CELL void operator()(std::int32_t c) const { cost[c] = c == goal ? 0U : field::kNoWay; }
};

/// Cells and the start field's steps to eight neighbours (settle_tiles.h).
struct StartWays {
  using Value = std::uint32_t;
  static constexpr Value kNone = field::kNoWay;
  static constexpr int kTile = 32, kLayers = 1, kReach = 1, kThreads = 512;
  field::Grid grid;
  const std::uint16_t* rate;
  Value* cost;

  [[nodiscard]] JAYWALK_CELL int side() const { return grid.side; }
  [[nodiscard]] __device__ bool holds(int i, int j) const { return grid.holds(i, j); }
  [[nodiscard]] __device__ int at(int i, int j, int) const { return grid.at(i, j); }
  [[nodiscard]] __device__ static std::uint32_t limit() { return field::kFarthest - 1; }
  [[nodiscard]] __device__ std::uint32_t rate_at(int i, int j) const { return holds(i, j) ? rate[grid.at(i, j)] : 0; }

  template <class Near>
  [[nodiscard]] __device__ std::uint32_t least(int i, int j, int, std::uint32_t own, std::uint32_t limit,
                                               const Near& near) const {
    const std::uint32_t here = rate_at(i, j);
    for (int k = 0; here != 0 && k < 9; ++k) {
      const int di = k % 3 - 1, dj = k / 3 - 1;
      const std::uint32_t there = near(di, dj, 0), rate_there = rate_at(i + di, j + dj);
      const std::uint32_t a = rate_at(i + di, j), b = rate_at(i, j + dj);  // of a straight step its own two cells
      if (k == 4 || there > limit || rate_there == 0 || a == 0 || b == 0) continue;
      const std::uint32_t through = there + (di == 0 || dj == 0 ? cell::straight_step(rate_there, here)
                                                                : cell::diagonal_step(rate_there, here, a, b));
      own = through < own ? through : own;
    }
    return own;
  }
};

}  // namespace jaywalk
