#pragma once
// An executor visits: it has memory and loops, and no mathematics. To the host it offers:
//   T* take<T>(n)                zeroed memory for n values, for stages alone
//   is_one_memory()              whether host and stages share theirs
//   T* show<T>(stages, n)        memory for n values that host and stages read and write: `stages` itself, memory that
//                                it gave, where they share theirs
//   fill(to, from, n)            n values from the host into memory for stages
//   begin(), end()               before and after a group of stages; false: it failed. After end() the host may read
//                                what was shown
//   kQueue                       whether the host's own loops beat stages here: a serial queue and repairs instead of
//                                settle(), columns and rows at a time instead of cells (pass.h)
//   took_ms()                    what all of it has taken on a device, by its own clock; 0 where the host visits
//   name()                       for reports
//   failure(), is_ready()        of executors that can fail: why the last did; whether the host may touch shown memory
//   has_failed()                 and begin again; whether one has failed since
//   settler()                    of those that settle costs of the time to go as well
// and between begin() and end(), to pass.h and what it calls:
//   copy(n, from, to)            n values from the host's memory to the stages' or back, where these are two
//   for_each(n, stage)           stage(k) for every k in [0, n), in any order
//   for_each_cell(w, h, stage)   stage(i, j) for every i in [0, w), j in [0, h), in any order
//   for_each_row(h, steps...)    the steps one after the other, each as for_each_cell does; or, to the same bits, all
//                                of them row by row, each a row behind the one before (RowStep says what that asks)
//   repeat(n, h, steps...)       for_each_row(h, steps...) n times over
//   total(n, counted)            the sums of n pairs of numbers, on which the host's next step depends
//   settle(grid, goal, arrays)   cost of the start field, from its rates
//   in_one_block(order)          order(...) of steps that are too small to be shared out among a device's blocks
//   kOneBlockSide                the largest board of blocks of cells that one block should take alone; 0: none
//   kLowerLevels                 whether it is such a block's: of boards of blocks alone
//   kCellsOfRow                  cells that one visit should take where a stage goes along rows; divides 64, or is
//                                kWholeRow
//   kInTurn                      whether visits come one after the other, so that many may write to the same place
// Every stage gives the same bits in any visiting order, so all executors agree to the last bit.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/cell/cell.h"

// Tells the compiler what holds for every stage: visits do not depend on one another, so they may go side by side.
#if defined(__GNUC__) && !defined(__clang__)
#define JAYWALK_INDEPENDENT_VISITS _Pragma("GCC ivdep")
#else
#define JAYWALK_INDEPENDENT_VISITS
#endif

#define JAYWALK_INLINED [[gnu::always_inline]] inline

/// Of functions that are an order or part of one: they run where their executor visits, on the host or, in one block,
/// on a device. Those apart are code once, and called: put into each of its callers a device's code would grow beyond
/// its caches.
#ifdef __CUDACC__
#define JAYWALK_ORDER __host__ __device__
#define JAYWALK_APART __host__ __device__ __noinline__
#else
#define JAYWALK_ORDER
#define JAYWALK_APART [[gnu::noinline]]
#endif

#if defined(__x86_64__) && !defined(__CUDACC__)
#define JAYWALK_CHOOSES_LANES 1
#define JAYWALK_EIGHT_LANES [[gnu::target("avx2")]]
#define JAYWALK_SIXTEEN_LANES [[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]]
#endif

namespace jaywalk::field {

/// Cells that a processor takes at a time; kFour is what every one of its kind can do.
enum class Lanes : std::uint8_t { kFour, kEight, kSixteen };

/// The most that this processor has instructions for.
inline Lanes most_lanes() {
#ifdef JAYWALK_CHOOSES_LANES
  const bool sixteen = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                       __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return sixteen ? Lanes::kSixteen : (__builtin_cpu_supports("avx2") ? Lanes::kEight : Lanes::kFour);
#else
  return Lanes::kFour;
#endif
}

/// A stage of a chain: `width` visits a row (0: none), on every row or, with `every` = 2, on rows of blocks, two cells
/// high. It may read what the steps before it have left in its own rows and in one row on either side, and must not
/// touch what they still read: its own rows, or arrays that they leave alone.
template <class Stage>
struct RowStep {
  std::int32_t width;
  Stage stage;
  std::int32_t every = 1;
};
template <class Stage>
RowStep(std::int32_t, Stage) -> RowStep<Stage>;
template <class Stage>
RowStep(std::int32_t, Stage, std::int32_t) -> RowStep<Stage>;

/// What a stage counts in a row or a piece of one.
struct Counted {
  std::int32_t cells = 0;   ///< those that it looks for
  std::int32_t joined = 0;  ///< those that it looks at
};

inline constexpr std::int32_t kWholeRow = 1 << 30;

/// Cells that a visit takes of a row of `side` cells, a power of two.
template <class Executor>
[[nodiscard]] JAYWALK_CELL constexpr std::int32_t cells_of_row(std::int32_t side) {
  return side < Executor::kCellsOfRow ? side : Executor::kCellsOfRow;
}

/// Pieces of that many cells that a grid has.
template <class Executor>
[[nodiscard]] constexpr std::size_t pieces_of_grid(std::int32_t side) {
  return static_cast<std::size_t>(side) * static_cast<std::size_t>(side / cells_of_row<Executor>(side));
}

/// Visits one after the other, on the caller's thread.
class SerialExecutor {
 public:
  static constexpr bool kQueue = true;
  static constexpr std::int32_t kCellsOfRow = kWholeRow;
  static constexpr bool kInTurn = true;
  static constexpr std::int32_t kOneBlockSide = 0;
  static constexpr bool kLowerLevels = false;

  /// With so many lanes, or as many as there are.
  explicit SerialExecutor(Lanes lanes = most_lanes()) : lanes_(std::min(lanes, most_lanes())) {}

  /// A few lines into a page, elsewhere for each array: grids are powers of two large, and arrays that all begin at the
  /// same place of a page would drive each other's cells from the nearest cache (a tenth of a solve).
  template <class T>
  T* take(std::size_t n) {
    static_assert(alignof(T) <= sizeof(Line));
    constexpr std::size_t kLinesOfPage = 64, kLinesApart = 13;
    const std::size_t shift = kLinesApart * blocks_.size() % kLinesOfPage;
    blocks_.push_back(std::make_unique<Line[]>(n * sizeof(T) / sizeof(Line) + 1 + shift));
    return reinterpret_cast<T*>(blocks_.back().get() + shift);
  }

  template <class T>
  T* show(T* stages, std::size_t) {
    return stages;
  }
  template <class T>
  void fill(T* to, const T* from, std::size_t n) {
    std::copy_n(from, n, to);
  }
  [[nodiscard]] static bool is_one_memory() noexcept { return true; }
  template <class T>
  static void copy(std::int32_t, const T*, T*) noexcept {}
  [[nodiscard]] static bool begin() noexcept { return true; }
  [[nodiscard]] static bool end() noexcept { return true; }

  template <class Order>
  void in_one_block(const Order& order) noexcept {
    order(*this);
  }

  [[nodiscard]] static double took_ms() noexcept { return 0.0; }

  template <class Stage>
  void for_each(std::int32_t n, const Stage& stage) noexcept {
    for_each_cell(n, 1, OnOneRow<Stage>{stage});
  }

  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) noexcept {
    repeat(1, h, RowStep<Stage>{w, stage});
  }

  /// Row by row, so that what one step has fetched is still at hand for the next.
  template <class... Steps>
  void for_each_row(std::int32_t h, const Steps&... steps) noexcept {
    repeat(1, h, steps...);
  }

  /// All rounds in one function, which holds the loops for these lanes: small boards have rows of a few cells.
  template <class... Steps>
  void repeat(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
#ifdef JAYWALK_CHOOSES_LANES
    if (lanes_ == Lanes::kSixteen) return visit_by_sixteen(n, h, steps...);
    if (lanes_ == Lanes::kEight) return visit_by_eight(n, h, steps...);
#endif
    visit_rows(n, h, steps...);
  }

  static Counted total(std::int32_t n, const Counted* counted) noexcept {
    Counted sum;
    for (std::int32_t k = 0; k < n; ++k) sum.cells += counted[k].cells, sum.joined += counted[k].joined;
    return sum;
  }
  [[nodiscard]] const char* name() const noexcept { return "cpu"; }

 private:
  /// A stage that knows no rows.
  template <class Stage>
  struct OnOneRow {
    Stage stage;
    JAYWALK_INLINED void operator()(std::int32_t k, std::int32_t) const { stage(k); }
  };

#ifdef JAYWALK_CHOOSES_LANES
  // No fused instructions among any of them: the bits are the same.
  template <class... Steps>
  JAYWALK_SIXTEEN_LANES static void visit_by_sixteen(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    visit_rows(n, h, steps...);
  }
  template <class... Steps>
  JAYWALK_EIGHT_LANES static void visit_by_eight(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    visit_rows(n, h, steps...);
  }
#endif

  template <class... Steps>
  JAYWALK_INLINED static void visit_rows(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    const std::int32_t end = h + static_cast<std::int32_t>(sizeof...(Steps)) - 1;
    for (std::int32_t k = 0; k < n; ++k) {
      for (std::int32_t front = 0; front < end; ++front) {
        std::int32_t row = front;
        (visit_row(h, row--, steps.width, steps.every, steps.stage), ...);
      }
    }
  }

  /// The stage is a copy, so that the compiler knows that nothing which a visit writes changes it.
  template <class Stage>
  JAYWALK_INLINED static void visit_row(std::int32_t h, std::int32_t row, std::int32_t width, std::int32_t every,
                                        Stage stage) noexcept {
    if (row < 0 || row >= h || (row + 1) % every != 0) return;
    const std::int32_t j = row / every;
    JAYWALK_INDEPENDENT_VISITS
    for (std::int32_t i = 0; i < width; ++i) stage(i, j);
  }

  /// Of a cache: what is fetched at a time.
  struct alignas(64) Line {
    std::byte bytes[64];
  };

  std::vector<std::unique_ptr<Line[]>> blocks_;
  Lanes lanes_;
};

}  // namespace jaywalk::field
