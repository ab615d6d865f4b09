#pragma once
// A plan's steps: marks and clearance, start field, solution, band. Between them the host chooses the goal and the
// path's start. Where loops on the processor are faster than stages, they are here; so is what the next plan reuses.
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include "planner/field/bucket_queue.h"
#include "planner/field/clearance_repair.h"
#include "planner/field/nearest_cell.h"
#include "planner/field/pull.h"
#include "planner/field/solve.h"

namespace jaywalk::field {

/// A call returns false, or a quality that is not `done`, where the executor has failed.
template <class Executor>
class Pass {
 public:
  Pass(Executor& executor, std::int32_t max_side)
      : executor_(executor),
        levels_(take_multigrid(executor, max_side)),
        a_(take_field(executor, max_side)),
        max_side_(max_side),
        queue_(Executor::kQueue ? max_side : 0, kQueuedPerCell * cells_looked_through(max_side)),
        cleared_occupants_(cells_looked_through(max_side)) {
    if constexpr (Executor::kQueue)
      last_rows_away_ = executor.template take<std::int32_t>(cells_looked_through(max_side));
  }

  [[nodiscard]] const FieldArrays& arrays() const noexcept { return a_; }
  /// What the host may read and write.
  [[nodiscard]] const ShownArrays& shown() const noexcept { return a_.shown; }

  /// Memory for a potential that solve() is to fill.
  [[nodiscard]] float* take_psi() {
    if (executor_.is_one_memory()) return take_rows<float>(executor_, max_side_);
    if (psi_ == nullptr) psi_ = take_rows<float>(executor_, max_side_);
    return executor_.show(psi_, static_cast<std::size_t>(Grid{max_side_}.cells()));
  }

  /// Warps, predicts, marks, and clears. The host has written walls into `occupants`, and `movers`.
  bool mark_and_clear(Grid grid, const Warping& warping, std::int32_t movers, float inflation,
                      std::uint8_t wanted) noexcept;

  /// Clearance from the occupants in `wanted`. Where the host looks through memory quickly, the same occupants as the
  /// last time keep their clearance, and the start field with it.
  bool clear(Grid grid, float inflation, std::uint8_t wanted) noexcept {
    return clear(grid, grid.side, grid.side, inflation, wanted);
  }
  /// The same where only the lowest width x height cells count.
  bool clear(Grid grid, std::int32_t width, std::int32_t height, float inflation, std::uint8_t wanted) noexcept;

  /// The next clear and start are done anew though nothing has changed: for measuring.
  void forget() noexcept {
    cleared_ = {};
    started_ = kNoCell;
  }

  /// The start field, in `cost` and `start_psi`, unless it is there.
  bool start(Grid grid, std::int32_t goal) noexcept;

  /// From clearance to the potential, in memory of take_psi, and its index matrix, if there is a start for the path
  /// near the robot.
  FieldQuality solve(Grid grid, std::int32_t goal, From from, const Disc& robot, float* psi) noexcept;
  FieldQuality solve(Grid grid, std::int32_t goal, From from, float* psi) noexcept {
    return solve(grid, goal, from, {goal % grid.side, goal / grid.side, 0}, psi);
  }

  /// Pulls the band's `count` points taut; those before `first` and the last stay.
  bool pull(Grid grid, std::int32_t first, std::int32_t count) noexcept;

 private:
  /// Room in the queue. A cell is queued 1.3 times in all, and few at a time.
  static constexpr std::size_t kQueuedPerCell = 1;

  /// What `clearance` is computed for, beside the occupants.
  struct Cleared {
    std::int32_t side = 0, width = 0, height = 0;
    float inflation = 0.0F;
    std::uint8_t wanted = 0;
    bool operator==(const Cleared&) const = default;
  };

  static std::size_t cells_looked_through(std::int32_t max_side) {
    return static_cast<std::size_t>(Executor::kQueue ? Grid{max_side}.cells() : 0);
  }

  /// Whether clearance is that of these occupants already; from now on it is taken to be.
  bool is_cleared(const Cleared& wanted) noexcept {
    const auto bytes = static_cast<std::size_t>(Grid{wanted.side}.cells());
    if (wanted == cleared_ && std::memcmp(a_.occupants, cleared_occupants_.data(), bytes) == 0) return true;
    std::memcpy(cleared_occupants_.data(), a_.occupants, bytes);
    cleared_ = wanted;
    return false;
  }

  // Parts of the above, between begin() and end() of the executor.
  void mark(Grid grid, const Warping& warping, std::int32_t movers) noexcept;
  void find_clearance(const Cleared& wanted) noexcept;
  void find_start(Grid grid, std::int32_t goal) noexcept;

  Executor& executor_;
  MultigridArrays levels_;
  FieldArrays a_;
  std::int32_t max_side_;
  float* psi_ = nullptr;  ///< the stages' own, where what they show lies elsewhere
  BucketQueue queue_;
  std::vector<std::uint8_t> cleared_occupants_;
  Cleared cleared_;
  std::int32_t* last_rows_away_ = nullptr;  ///< for repairs
  std::int32_t started_ = kNoCell;          ///< goal of the start field that belongs to the clearance
};

// Members that hold an executor's loops follow: not inline, so that the processor's are compiled once (serial_pass.cc).

template <class Executor>
bool Pass<Executor>::mark_and_clear(Grid grid, const Warping& warping, std::int32_t movers, float inflation,
                                    std::uint8_t wanted) noexcept {
  if (!executor_.begin()) return false;
  executor_.copy(grid.cells(), a_.shown.occupants, a_.occupants);
  mark(grid, warping, movers);
  find_clearance({grid.side, grid.side, grid.side, inflation, wanted});
  return executor_.end();
}

template <class Executor>
void Pass<Executor>::mark(Grid grid, const Warping& warping, std::int32_t movers) noexcept {
  const std::int32_t cells = cells_of_row<Executor>(grid.side);
  executor_.copy(movers, a_.shown.movers, a_.movers);
  executor_.for_each_cell(grid.side, grid.side, WarpOfEachCell{grid, warping, a_.warp});
  executor_.for_each(movers, PredictEachMover{grid, warping, a_.warp, a_.movers, a_.marks});
  executor_.for_each_cell(grid.side / cells, grid.side,
                          MarkRow{grid, cells, warping, a_.warp, a_.movers, a_.marks, movers, a_.occupants});
  executor_.copy(grid.cells(), a_.occupants, a_.shown.occupants);
  executor_.copy(movers, a_.marks, a_.shown.marks);
}

template <class Executor>
bool Pass<Executor>::clear(Grid grid, std::int32_t width, std::int32_t height, float inflation,
                           std::uint8_t wanted) noexcept {
  if (!executor_.begin()) return false;
  executor_.copy(grid.cells(), a_.shown.occupants, a_.occupants);
  find_clearance({grid.side, width, height, inflation, wanted});
  return executor_.end();
}

/// On the host it repairs the last clearance where only the occupants have changed.
template <class Executor>
void Pass<Executor>::find_clearance(const Cleared& wanted) noexcept {
  const Grid grid{wanted.side};
  if constexpr (Executor::kQueue) {
    constexpr std::int32_t kColumns = 64;  // that a visit takes: a line of a cache
    const bool keeps = wanted == cleared_;
    if (is_cleared(wanted)) return;
    if (keeps) std::swap(a_.rows_away, last_rows_away_);
    const ClearanceOfRow rows{grid,        wanted.width, wanted.height, a_.rows_away, wanted.inflation,
                              a_.envelope, a_.stretch,   a_.clearance};
    executor_.for_each(grid.side / kColumns,
                       NearestInColumns{grid, kColumns, a_.occupants, wanted.wanted, a_.rows_away});
    if (keeps) executor_.for_each(grid.side, RepairClearanceOfRow{rows, last_rows_away_});
    if (!keeps) executor_.for_each(grid.side, rows);
  } else {
    executor_.for_each_cell(grid.side, grid.side / kRowsOfWord,
                            OccupiedInColumn{grid, a_.occupants, wanted.wanted, a_.columns});
    executor_.for_each_cell(grid.side, grid.side, NearestInColumn{grid, a_.columns, a_.rows_away});
    executor_.for_each_cell(
        grid.side, grid.side,
        ClearanceOfCell{grid, wanted.width, wanted.height, a_.rows_away, wanted.inflation, a_.clearance});
    executor_.copy(grid.cells(), a_.clearance, a_.shown.clearance);
  }
  started_ = kNoCell;
}

template <class Executor>
bool Pass<Executor>::start(Grid grid, std::int32_t goal) noexcept {
  if (!executor_.begin()) return false;
  find_start(grid, goal);
  return executor_.end();
}

template <class Executor>
void Pass<Executor>::find_start(Grid grid, std::int32_t goal) noexcept {
  if (std::exchange(started_, goal) == goal) return;
  executor_.for_each_cell(grid.side, grid.side, RateOfEachCell{grid, a_.clearance, a_.table, a_.rate});
  if constexpr (Executor::kQueue) {
    queue_.settle(grid, goal, a_.rate, a_.cost);
  } else {
    executor_.settle(grid, goal, a_);
  }
  executor_.for_each(grid.cells(), PsiOfCost{a_.rate, a_.cost, a_.start_psi});
}

template <class Executor>
FieldQuality Pass<Executor>::solve(Grid grid, std::int32_t goal, From from, const Disc& robot, float* psi) noexcept {
  if (!executor_.begin()) return {};
  find_start(grid, goal);
  float* const solved = executor_.is_one_memory() ? psi : psi_;
  Solve<Executor> solve(executor_, levels_, a_, grid, goal, solved);
  FieldQuality quality;
  if (solve.has_joined(robot)) {
    quality = solve.begin_with(from);
    executor_.copy(grid.cells(), a_.index, a_.shown.index);
    executor_.copy(grid.cells(), solved, psi);
  }
  if (!executor_.end()) return {};
  quality.done = true;
  return quality;
}

template <class Executor>
bool Pass<Executor>::pull(Grid grid, std::int32_t first, std::int32_t count) noexcept {
  if (!executor_.begin()) return false;
  executor_.copy(count, a_.shown.points, a_.points);
  executor_.in_one_block(PullInOneBlock{a_, grid, first, count});
  executor_.copy(count, a_.points, a_.shown.points);
  return executor_.end();
}

extern template class Pass<SerialExecutor>;

}  // namespace jaywalk::field
