#pragma once
// An executor visits: it has memory and loops, and no mathematics. To the host it offers:
//   T* take<T>(n)                zeroed memory for n values, for stages alone
//   T* show<T>(stages, n)        memory for n values that host and stages read and write: `stages` itself, memory that
//                                it gave, where they share theirs
//   is_ready()                   whether the host may touch what is shown and begin again
//   begin(), end()               before and after a group of stages; false: it failed. After end() the host may read
//                                what was copied out
//   failure()                    why the last did, in a few words; empty where none has failed since it was ready
//   took_ms(), name()            for reports: time taken on a device, by its own clock; 0 where the host visits
// and between begin() and end():
//   copy(n, from, to)            n values from what is shown to the stages' own or back, where these are two
//   for_each_cell(w, h, stage)   stage(i, j) for every i in [0, w), j in [0, h), in any order; stage(i) where it takes
//                                one number, and h is 1. Of several rows w is a power of two
//   total(n, counted)            the sums of n pairs of numbers, on which the host's next step depends
// Every stage gives the same bits in any visiting order, so all executors agree to the last bit.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/cell/cell.h"
#include "planner/mapping/window.h"

// Tells the compiler what holds for every stage: visits do not depend on one another, so they may go side by side.
#if defined(__GNUC__) && !defined(__clang__)
#define JAYWALK_INDEPENDENT_VISITS _Pragma("GCC ivdep")
#else
#define JAYWALK_INDEPENDENT_VISITS
#endif

namespace jaywalk::paper {
using field::Grid;

/// Memory for a grid's values by rows, with a spare row and a cell at either end: stages may read beyond the border.
template <class T, class Executor>
[[nodiscard]] T* take_rows(Executor& executor, std::int32_t side) {
  const auto spare = static_cast<std::size_t>(side) + 1;
  return executor.template take<T>(static_cast<std::size_t>(Grid{side}.cells()) + 2 * spare) + spare;
}

/// Counts of a stage in a row.
struct Counted {
  std::int32_t cells = 0;   ///< those that it looks for
  std::int32_t joined = 0;  ///< those that it looks at
};

/// Visits one after the other, on the caller's thread.
class SerialExecutor {
 public:
  template <class T>
  T* take(std::size_t n) {
    static_assert(alignof(T) <= alignof(std::max_align_t));
    blocks_.push_back(std::make_unique<std::byte[]>(n * sizeof(T)));
    return reinterpret_cast<T*>(blocks_.back().get());
  }
  template <class T>
  T* show(T* stages, std::size_t) {
    return stages;
  }
  [[nodiscard]] static bool is_ready() noexcept { return true; }
  [[nodiscard]] static bool begin() noexcept { return true; }
  [[nodiscard]] static bool end() noexcept { return true; }
  [[nodiscard]] static const char* failure() noexcept { return ""; }
  [[nodiscard]] static double took_ms() noexcept { return 0.0; }
  [[nodiscard]] static const char* name() noexcept { return "cpu"; }

  template <class T>
  static void copy(std::int32_t, const T*, T*) noexcept {}
  /// The stage is a copy, so that the compiler knows that nothing which a visit writes changes it.
  template <class Stage>
  static void for_each_cell(std::int32_t w, std::int32_t h, Stage stage) noexcept {
    for (std::int32_t j = 0; j < h; ++j) {
      JAYWALK_INDEPENDENT_VISITS
      for (std::int32_t i = 0; i < w; ++i) {
        if constexpr (requires { stage(i, j); }) {
          stage(i, j);
        } else {
          stage(i);
        }
      }
    }
  }
  static Counted total(std::int32_t n, const Counted* counted) noexcept {
    Counted sum;
    for (std::int32_t k = 0; k < n; ++k) sum.cells += counted[k].cells, sum.joined += counted[k].joined;
    return sum;
  }

 private:
  std::vector<std::unique_ptr<std::byte[]>> blocks_;
};

}  // namespace jaywalk::paper
