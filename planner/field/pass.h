#pragma once
// The order of stages, once for every executor. Between the calls the host chooses goal and start.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "planner/field/bucket_queue.h"
#include "planner/field/clearance_stages.h"
#include "planner/field/mark_stages.h"
#include "planner/field/multigrid.h"
#include "planner/field/path_stages.h"
#include "planner/field/start_field.h"
#include "planner/perception/track.h"

namespace jaywalk::field {

/// Most cells that a raw path may have; a longer one is cut there, and leads towards the goal.
inline constexpr std::int32_t kMaxBandPoints = 16384;
/// Rounds of the band: enough for a corner to spread over its dozen neighbours.
inline constexpr std::int32_t kBandRounds = 60;
/// Rounds of tension alone between two looks at the band's length.
inline constexpr std::int32_t kTautRounds = 4;
/// Clearance (cells beyond inflation) below which things push the band: 0.5 m.
inline constexpr float kBandReach = 5.0F;
/// Cycles from the start field: three, and on while the last has still found something, up to five; then 99.9 % of
/// cells or more pick the exact field's best neighbour. (Six take longer than 100 plain sweeps where eight lanes are
/// the most.) On windows of more than 256 cells a side four are the most, for the time they take. From the last
/// submission's field one does where nothing has changed since, and a second where the first has found something
/// (docs/algorithm.md).
inline constexpr std::int32_t kColdCycles = 3, kMostColdCycles = 5, kWarmCycles = 1, kMostWarmCycles = 2;
[[nodiscard]] constexpr std::int32_t most_cold_cycles(Grid grid) { return grid.side > 256 ? 4 : kMostColdCycles; }

/// Times that pits are lifted at most, and before the certificate is read again. A pit that rounding has made is a
/// plateau a few cells wide; one that is deeper needs another solution.
inline constexpr std::int32_t kLifts = 32, kLiftsAtOnce = 4;

/// What the stages read and write; all of it the executor's memory.
struct FieldArrays {
  std::uint8_t *occupants, *cleared_occupants;
  float* warp;
  Mover* movers;
  Mark* marks;
  std::int32_t *rows_away, *envelope, *stretch;
  float* clearance;
  float *start_psi, *correction;
  std::uint16_t *table, *rate;
  std::uint32_t *cost, *changed;
  std::uint8_t* index;
  std::int32_t *pits, *joined;
  cell::Point* points;
};

/// What a solution begins from.
enum class From : std::uint8_t {
  kLast,       ///< the last one, which must have been on the same cells with the same goal
  kNothing,    ///< the start field
  kStartOnly,  ///< the start field, and leave it at that
};

/// How the potential came out.
struct FieldQuality {
  bool certified = false;
  std::int32_t pits = 0;    ///< joined cells without a lower neighbour
  std::int32_t joined = 0;  ///< cells that the goal can be reached from
  std::int32_t cycles = 0;
};

template <class Executor>
class Pass {
 public:
  Pass(Executor& executor, std::int32_t max_side)
      : executor_(executor),
        solver_(executor, max_side),
        queue_(Executor::kQueue ? max_side : 0,
               kQueuedPerCell * static_cast<std::size_t>(Executor::kQueue ? Grid{max_side}.cells() : 0)),
        raw_(static_cast<std::size_t>(kMaxBandPoints)) {
    const auto cells = static_cast<std::size_t>(Grid{max_side}.cells());
    const auto lines = static_cast<std::size_t>(max_side);
    const std::vector<std::uint16_t> table = rate_table(max_side);
    take(a_.occupants, cells), take(a_.cleared_occupants, cells), take(a_.warp, cells), take(a_.movers, kMaxTracks),
        take(a_.marks, kMaxTracks);
    take(a_.rows_away, cells), take(a_.envelope, cells), take(a_.stretch, cells), take(a_.clearance, cells);
    take(a_.start_psi, cells), take(a_.correction, cells);
    take(a_.table, table.size()), take(a_.rate, cells), take(a_.cost, cells), take(a_.changed, lines);
    take(a_.index, cells), take(a_.pits, lines), take(a_.joined, lines);
    take(a_.points, static_cast<std::size_t>(kMaxBandPoints));
    for (std::size_t k = 0; k < table.size(); ++k) a_.table[k] = table[k];
  }

  [[nodiscard]] const FieldArrays& arrays() const noexcept { return a_; }

  /// Warps, predicts, marks. The host has written walls into `occupants`, and `movers`.
  bool mark(Grid grid, const Warping& warping, std::int32_t movers) noexcept {
    executor_.for_each_cell(grid.side, grid.side, WarpOfEachCell{grid, warping, a_.warp});
    executor_.for_each(movers, PredictEachMover{grid, warping, a_.warp, a_.movers, a_.marks});
    executor_.for_each(grid.side, MarkRow{grid, warping, a_.warp, a_.movers, a_.marks, movers, a_.occupants});
    return executor_.wait();
  }

  /// Clearance from the occupants in `wanted`. Where the host looks through memory quickly, the same occupants as the
  /// last time keep their clearance, and the start field with it.
  bool clear(Grid grid, float inflation, std::uint8_t wanted) noexcept {
    return clear(grid, grid.side, grid.side, inflation, wanted);
  }
  /// The same where only the lowest width x height cells count.
  bool clear(Grid grid, std::int32_t width, std::int32_t height, float inflation, std::uint8_t wanted) noexcept {
    if (Executor::kQueue && is_cleared(grid, {grid.side, width, height, inflation, wanted})) return true;
    started_ = kNowhere;
    constexpr std::int32_t kColumns = Executor::kColumns;
    executor_.for_each(grid.side / kColumns, NearestInColumns{grid, kColumns, a_.occupants, wanted, a_.rows_away});
    executor_.for_each(
        grid.side, ClearanceOfRow{grid, width, height, a_.rows_away, inflation, a_.envelope, a_.stretch, a_.clearance});
    return executor_.wait();
  }

  /// The next clear and start are done anew though nothing has changed: for measuring.
  void forget() noexcept {
    cleared_ = {};
    started_ = kNowhere;
  }

  /// The start field, in `cost` and `start_psi`.
  bool start(Grid grid, std::int32_t goal) noexcept {
    if (Executor::kQueue && started_ == goal) return true;
    started_ = goal;
    executor_.for_each_cell(grid.side, grid.side, RateOfEachCell{grid, a_.clearance, a_.table, a_.rate});
    if (!settle(grid, goal)) return false;
    executor_.for_each(grid.cells(), PsiOfCost{a_.rate, a_.cost, a_.start_psi});
    return executor_.wait();
  }

  /// From the start field to the potential and its index matrix. Whatever breaks the certificate is not used: a
  /// solution from the last gives way to one from the start field, that to one with twice the cycles, and that to the
  /// start field itself.
  FieldQuality solve(Grid grid, std::int32_t goal, From from, float* psi) noexcept {
    struct Attempt {
      From from;
      bool anew;  ///< from the start field, not from what the attempt before came to
      std::int32_t least_cycles, most_cycles, lifts;
    };
    const std::int32_t most = most_cold_cycles(grid);
    const Attempt attempts[] = {{From::kLast, false, kWarmCycles, kMostWarmCycles, kLifts},
                                {From::kNothing, true, kColdCycles, most, kLifts},
                                {From::kNothing, false, most, most, kLifts},
                                {From::kStartOnly, true, 0, 0, 2 * grid.side}};
    FieldQuality quality;
    for (const Attempt& attempt : attempts) {
      if (attempt.from < from || quality.certified) continue;
      if (attempt.anew) executor_.for_each(grid.cells(), Fill<float>{a_.correction, 0.0F});
      quality.cycles += improve(grid, goal, attempt.least_cycles, attempt.most_cycles, psi);
      if (!lift(grid, goal, attempt.lifts, psi, quality)) break;
    }
    return quality;
  }

  /// Pulls the band's `count` points taut; those before `first` and the last stay. The band is no longer than the raw
  /// path: where what is near has made it so, tension alone draws it in, and where that takes too long, tension alone
  /// acts on the raw path. Tension never lengthens: a point goes towards the middle of its neighbours.
  bool pull(Grid grid, std::int32_t first, std::int32_t count) noexcept {
    const double raw_length = length_of(a_.points, count);
    std::copy_n(a_.points, count, raw_.begin());
    if (!drag(grid, first, count, kBandReach, kBandRounds)) return false;
    for (std::int32_t r = 0; r < kBandRounds && length_of(a_.points, count) > raw_length; r += kTautRounds) {
      if (!drag(grid, first, count, 0.0F, kTautRounds)) return false;
    }
    if (length_of(a_.points, count) <= raw_length) return true;
    std::copy_n(raw_.begin(), count, a_.points);
    return drag(grid, first, count, 0.0F, kBandRounds);
  }

 private:
  static constexpr std::int32_t kNowhere = -1;
  /// Room in the queue. A cell is queued 1.3 times in all, and few at a time; where that should ever not do, sweeps do.
  static constexpr std::size_t kQueuedPerCell = 1;

  /// What `clearance` was computed for, beside the occupants.
  struct Cleared {
    std::int32_t side = 0, width = 0, height = 0;
    float inflation = 0.0F;
    std::uint8_t wanted = 0;
    bool operator==(const Cleared&) const = default;
  };

  /// Whether clearance is that of these occupants already; from now on it is taken to be.
  bool is_cleared(Grid grid, const Cleared& wanted) noexcept {
    const auto bytes = static_cast<std::size_t>(grid.cells());
    if (wanted == cleared_ && std::memcmp(a_.occupants, a_.cleared_occupants, bytes) == 0) return true;
    std::memcpy(a_.cleared_occupants, a_.occupants, bytes);
    cleared_ = wanted;
    return false;
  }

  template <class T>
  void take(T*& array, std::size_t n) {
    array = executor_.template take<T>(n);
  }

  std::int32_t improve(Grid grid, std::int32_t goal, std::int32_t least, std::int32_t most, float* psi) noexcept {
    return solver_.improve(grid, goal, psi, least, most,
                           RowStep{grid.side, AddCorrection{grid, a_.start_psi, a_.correction, psi}},
                           RowStep{1, PitsOfRow{grid, goal, psi, a_.pits, a_.joined}},
                           RowStep{grid.side, KeepCorrection{grid, a_.start_psi, psi, a_.correction}},
                           RowStep{grid.side, IndexOfEachCell{grid, psi, a_.index}});
  }

  /// Reads the certificate; where there are pits, lifts them up to `most` times over, and keeps what that came to.
  /// False when the executor has failed.
  bool lift(Grid grid, std::int32_t goal, std::int32_t most, float* psi, FieldQuality& quality) noexcept {
    if (!read_certificate(grid, quality)) return false;
    if (quality.certified) return true;
    for (std::int32_t lifts = 0; !quality.certified && lifts < most; lifts += kLiftsAtOnce) {
      for (std::int32_t k = 1; k <= kLiftsAtOnce; ++k) {
        executor_.for_each_row(grid.side, RowStep{1, LiftPitsOfRow{grid, 0, goal, 2 * k - 1, a_.pits, psi}},
                               RowStep{1, LiftPitsOfRow{grid, 1, goal, 2 * k, a_.pits, psi}});
      }
      executor_.for_each_cell(1, grid.side, PitsOfRow{grid, goal, psi, a_.pits, a_.joined});
      if (!read_certificate(grid, quality)) return false;
    }
    executor_.for_each_row(grid.side, RowStep{grid.side, KeepCorrection{grid, a_.start_psi, psi, a_.correction}},
                           RowStep{grid.side, IndexOfEachCell{grid, psi, a_.index}});
    return executor_.wait();
  }

  bool drag(Grid grid, std::int32_t first, std::int32_t count, float reach, std::int32_t rounds) noexcept {
    for (std::int32_t third = 0; third < 3 * rounds; ++third) {
      const std::int32_t from = first + third % 3;
      executor_.for_each((count - from + 1) / 3, PullBand{grid, from, count, a_.clearance, reach, a_.points});
    }
    return executor_.wait();
  }

  bool read_certificate(Grid grid, FieldQuality& quality) noexcept {
    quality.pits = quality.joined = 0;
    quality.certified = false;
    if (!executor_.wait()) return false;
    for (std::int32_t j = 0; j < grid.side; ++j) quality.pits += a_.pits[j], quality.joined += a_.joined[j];
    quality.certified = quality.pits == 0;
    return true;
  }

  bool settle(Grid grid, std::int32_t goal) noexcept {
    if (!Executor::kQueue) return sweep_until_settled(grid, goal);
    if (!executor_.wait()) return false;
    return queue_.settle(grid, goal, a_.rate, a_.cost) || sweep_until_settled(grid, goal);
  }

  bool sweep_until_settled(Grid grid, std::int32_t goal) noexcept {
    executor_.for_each(grid.cells(), FarFromGoal{goal, a_.cost});
    for (bool settled = false; !settled;) {
      executor_.for_each(grid.side, Fill<std::uint32_t>{a_.changed, 0U});
      executor_.for_each(grid.side, SweepLine{grid.side, 1, grid.side, a_.rate, a_.cost, a_.changed});
      executor_.for_each(grid.side, SweepLine{grid.side, grid.side, 1, a_.rate, a_.cost, a_.changed});
      executor_.for_each_cell(grid.side, grid.side / 2, StepAcross{grid, 0, a_.rate, a_.cost, a_.changed});
      executor_.for_each_cell(grid.side, grid.side / 2, StepAcross{grid, 1, a_.rate, a_.cost, a_.changed});
      if (!executor_.wait()) return false;
      settled = true;
      for (std::int32_t line = 0; line < grid.side; ++line) settled = settled && a_.changed[line] == 0;
    }
    return true;
  }

  Executor& executor_;
  FieldArrays a_{};
  Multigrid<Executor> solver_;
  BucketQueue queue_;
  std::vector<cell::Point> raw_;  ///< the path before it was pulled
  Cleared cleared_;
  std::int32_t started_ = kNowhere;  ///< goal of the start field that belongs to the clearance
};

}  // namespace jaywalk::field
