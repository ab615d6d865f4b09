#pragma once
// From walls and movers to a taut band, one order after the other; between them the host chooses goal and path's start.
// What a processor's own loops do better than stages is here, and what is remembered from order to order.
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include "planner/field/bucket_queue.h"
#include "planner/field/clearance_repair.h"
#include "planner/field/nearest_cell.h"
#include "planner/field/order.h"

namespace jaywalk::field {

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
    if (is_one_memory()) return take_rows<float>(executor_, max_side_);
    if (psi_ == nullptr) psi_ = take_rows<float>(executor_, max_side_);
    return executor_.show(psi_, static_cast<std::size_t>(Grid{max_side_}.cells()));
  }

  /// Warps, predicts, marks, and clears.
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
  /// Room in the queue. A cell is queued 1.3 times in all, and few at a time; where that should ever not do, sweeps do.
  static constexpr std::size_t kQueuedPerCell = 1;

  /// What `clearance` was computed for, beside the occupants.
  struct Cleared {
    std::int32_t side = 0, width = 0, height = 0;
    float inflation = 0.0F;
    std::uint8_t wanted = 0;
    bool operator==(const Cleared&) const = default;
  };

  [[nodiscard]] bool is_one_memory() const noexcept {
    if constexpr (requires { executor_.is_one_memory(); }) return executor_.is_one_memory();
    return Executor::kOneMemory;
  }

  static std::size_t cells_looked_through(std::int32_t max_side) {
    return static_cast<std::size_t>(Executor::kQueue ? Grid{max_side}.cells() : 0);
  }

  /// Clearance of other occupants, from that of the last ones.
  void repair(const ClearOrder& order) noexcept;

  /// Whether clearance is that of these occupants already; from now on it is taken to be.
  bool is_cleared(Grid grid, const Cleared& wanted) noexcept {
    const auto bytes = static_cast<std::size_t>(grid.cells());
    if (wanted == cleared_ && std::memcmp(a_.occupants, cleared_occupants_.data(), bytes) == 0) return true;
    std::memcpy(cleared_occupants_.data(), a_.occupants, bytes);
    cleared_ = wanted;
    return false;
  }

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
  const MarkOrder mark{a_, grid, warping, movers};
  if constexpr (Executor::kQueue) return executor_.run(mark) && clear(grid, inflation, wanted);
  started_ = kNoCell;
  return executor_.run(MarkAndClearOrder{mark, {a_, grid, grid.side, grid.side, inflation, wanted}});
}

template <class Executor>
bool Pass<Executor>::clear(Grid grid, std::int32_t width, std::int32_t height, float inflation,
                           std::uint8_t wanted) noexcept {
  const ClearOrder order{a_, grid, width, height, inflation, wanted};
  if constexpr (Executor::kQueue) {
    const Cleared now{grid.side, width, height, inflation, wanted};
    const bool keeps = now == cleared_;
    if (is_cleared(grid, now)) return true;
    started_ = kNoCell;
    if (keeps) return repair(order), true;
  }
  started_ = kNoCell;
  return executor_.run(order);
}

template <class Executor>
bool Pass<Executor>::start(Grid grid, std::int32_t goal) noexcept {
  if (started_ == goal) return true;
  started_ = goal;
  const StartOrder order{a_, grid, goal};
  if constexpr (Executor::kQueue) {
    order.rate(executor_);
    if (queue_.settle(grid, goal, a_.rate, a_.cost)) {
      order.carry_over(executor_);
      return true;
    }
  }
  return executor_.run(order);
}

template <class Executor>
FieldQuality Pass<Executor>::solve(Grid grid, std::int32_t goal, From from, const Disc& robot, float* psi) noexcept {
  if constexpr (Executor::kQueue) (void)start(grid, goal);
  const bool is_started = started_ == goal;
  started_ = goal;
  float* solved = is_one_memory() ? psi : psi_;
  FieldQuality found;
  if (!executor_.run(SolveOrder{{a_, grid, goal}, is_started, levels_, from, robot, solved, psi, &found})) return {};
  return found;
}

template <class Executor>
bool Pass<Executor>::pull(Grid grid, std::int32_t first, std::int32_t count) noexcept {
  return executor_.run(PullOrder{{a_, grid, first, count}});
}

template <class Executor>
void Pass<Executor>::repair(const ClearOrder& order) noexcept {
  std::swap(a_.rows_away, last_rows_away_);
  const Grid grid = order.grid;
  constexpr std::int32_t kColumns = Executor::kColumns;
  executor_.for_each(grid.side / kColumns, NearestInColumns{grid, kColumns, a_.occupants, order.wanted, a_.rows_away});
  executor_.for_each(grid.side, RepairClearanceOfRow{order.rows(a_.rows_away), last_rows_away_});
}

extern template class Pass<SerialExecutor>;

}  // namespace jaywalk::field
