#pragma once
// An executor visits: it has memory and loops, and no mathematics. What it must offer:
//   T* take<T>(n)                zeroed memory for n values, its own, readable by the host after wait()
//   for_each(n, stage)           stage(k) for every k in [0, n), in any order
//   for_each_cell(w, h, stage)   stage(i, j) for every i in [0, w), j in [0, h), in any order
//   for_each_row(h, steps...)    the steps one after the other, each as for_each_cell does; or, to the same bits, all
//   of
//                                them row by row, each a row behind the one before (RowStep says what that asks)
//   repeat(n, h, steps...)       for_each_row(h, steps...) n times over
//   wait()                       returns when all that was asked for is done; false: it failed
//   kQueue                       whether the host's own loops beat stages here: a serial queue instead of sweeps
//                                (start_field.h), looking whether anything has changed (pass.h)
//   kColumns                     columns that one visit should take where a stage goes down columns; divides 64
//   name()                       for reports
// Every stage gives the same bits in any visiting order, so all executors agree to the last bit.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

// Tells the compiler what holds for every stage: visits do not depend on one another, so they may go side by side.
#if defined(__GNUC__) && !defined(__clang__)
#define JAYWALK_INDEPENDENT_VISITS _Pragma("GCC ivdep")
#else
#define JAYWALK_INDEPENDENT_VISITS
#endif

#if defined(__x86_64__) && !defined(__CUDACC__)
#define JAYWALK_EIGHT_WIDE [[gnu::target("avx2")]]
#else
#define JAYWALK_EIGHT_WIDE
#endif

namespace jaywalk::field {

/// Whether this processor has the instructions of JAYWALK_EIGHT_WIDE.
inline bool goes_eight_wide() {
#if defined(__x86_64__) && !defined(__CUDACC__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
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

/// Visits one after the other, on the caller's thread.
class SerialExecutor {
 public:
  static constexpr bool kQueue = true;
  static constexpr std::int32_t kColumns = 64;

  template <class T>
  T* take(std::size_t n) {
    // new[] of bytes is aligned for any fundamental type, which is 16 on all our machines.
    static_assert(alignof(T) <= 16);
    blocks_.push_back(std::make_unique<std::byte[]>(n * sizeof(T)));
    return reinterpret_cast<T*>(blocks_.back().get());
  }

  template <class Stage>
  void for_each(std::int32_t n, Stage stage) noexcept {
    wide_ ? visit_wide(n, stage) : visit(n, stage);
  }

  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, Stage stage) noexcept {
    for (std::int32_t j = 0; j < h; ++j) {
      wide_ ? visit_wide(w, stage, j) : visit(w, stage, j);
    }
  }

  /// Row by row, so that what one step has fetched is still at hand for the next.
  template <class... Steps>
  void for_each_row(std::int32_t h, const Steps&... steps) noexcept {
    const std::int32_t end = h + static_cast<std::int32_t>(sizeof...(Steps)) - 1;
    for (std::int32_t front = 0; front < end; ++front) {
      std::int32_t row = front;
      (visit_row(h, row--, steps), ...);
    }
  }

  template <class... Steps>
  void repeat(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    for (std::int32_t k = 0; k < n; ++k) for_each_row(h, steps...);
  }

  bool wait() noexcept { return true; }
  [[nodiscard]] const char* name() const noexcept { return "cpu"; }

 private:
  template <class Step>
  void visit_row(std::int32_t h, std::int32_t row, const Step& step) noexcept {
    if (row < 0 || row >= h || (row + 1) % step.every != 0) return;
    const std::int32_t j = row / step.every;
    wide_ ? visit_wide(step.width, step.stage, j) : visit(step.width, step.stage, j);
  }

  template <class Stage, class... Row>
  static void visit(std::int32_t n, Stage stage, Row... row) noexcept {
    JAYWALK_INDEPENDENT_VISITS
    for (std::int32_t k = 0; k < n; ++k) stage(k, row...);
  }

  /// The same loop in instructions for eight cells at a time, which not every processor has. No fused ones
  /// among them: the bits are the same.
  template <class Stage, class... Row>
  JAYWALK_EIGHT_WIDE static void visit_wide(std::int32_t n, Stage stage, Row... row) noexcept {
    JAYWALK_INDEPENDENT_VISITS
    for (std::int32_t k = 0; k < n; ++k) stage(k, row...);
  }

  std::vector<std::unique_ptr<std::byte[]>> blocks_;
  bool wide_ = goes_eight_wide();
};

}  // namespace jaywalk::field
