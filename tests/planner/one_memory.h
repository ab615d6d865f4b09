#pragma once
#include <algorithm>
#include <cstddef>

#include "planner/field/field_arrays.h"

namespace jaywalk::test {

/// What executors for tests have in common that visit on the host: one memory, and the start field by asking every cell
/// of its neighbours until nothing changes.
class OneMemory {
 public:
  static constexpr bool kQueue = false;
  static constexpr std::int32_t kCellsOfRow = 16, kOneBlockSide = 0;
  static constexpr bool kInTurn = true, kLowerLevels = false;

  template <class T>
  T* take(std::size_t n) {
    return memory_.take<T>(n);
  }
  template <class T>
  T* show(T* stages, std::size_t) {
    return stages;
  }
  template <class T>
  void fill(T* to, const T* from, std::size_t n) {
    memory_.fill(to, from, n);
  }
  [[nodiscard]] static bool is_one_memory() noexcept { return true; }
  template <class T>
  static void copy(std::int32_t, const T*, T*) noexcept {}
  [[nodiscard]] static bool begin() noexcept { return true; }
  [[nodiscard]] static bool end() noexcept { return true; }
  [[nodiscard]] static double took_ms() noexcept { return 0.0; }
  static field::Counted total(std::int32_t n, const field::Counted* counted) {
    return field::SerialExecutor::total(n, counted);
  }

  static void settle(field::Grid grid, std::int32_t goal, const field::FieldArrays& a) {
    std::fill_n(a.cost, grid.cells(), field::kNoWay);
    a.cost[goal] = 0;
    for (bool any = true; any;) {
      any = false;
      for (std::int32_t c = 0; c < grid.cells(); ++c) {
        const std::uint32_t least = through_neighbours(grid, a, c % grid.side, c / grid.side);
        any |= least < a.cost[c];
        a.cost[c] = std::min(a.cost[c], least);
      }
    }
  }

 private:
  /// A diagonal step is one between two free cells.
  static std::uint32_t through_neighbours(field::Grid grid, const field::FieldArrays& a, std::int32_t i,
                                          std::int32_t j) {
    const auto rate = [&](std::int32_t x, std::int32_t y) -> std::uint32_t {
      return grid.holds(x, y) ? a.rate[grid.at(x, y)] : 0;
    };
    std::uint32_t least = field::kNoWay;
    for (std::int32_t k = 0; k < 9 && rate(i, j) != 0; ++k) {
      const std::int32_t x = i + k % 3 - 1, y = j + k / 3 - 1;
      if (k == 4 || rate(x, y) == 0 || rate(x, j) == 0 || rate(i, y) == 0) continue;
      const std::uint32_t step = x == i || y == j ? cell::straight_step(rate(x, y), rate(i, j))
                                                  : cell::diagonal_step(rate(x, y), rate(i, j), rate(x, j), rate(i, y));
      const std::uint32_t there = a.cost[grid.at(x, y)];
      if (there < field::kFarthest) least = std::min(least, there + step);
    }
    return least;
  }

  field::SerialExecutor memory_;
};

}  // namespace jaywalk::test
