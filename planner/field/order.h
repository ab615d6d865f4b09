#pragma once
// The order of stages, once for every executor: what is done to a window's arrays between two choices of the planner.
#include "planner/field/clearance_stages.h"
#include "planner/field/field_arrays.h"
#include "planner/field/multigrid.h"

namespace jaywalk::field {

/// Rounds of the band: enough for a corner to spread over its dozen neighbours.
inline constexpr std::int32_t kBandRounds = 60;
/// Rounds of tension alone between two looks at the band's length.
inline constexpr std::int32_t kTautRounds = 4;
/// Clearance (cells beyond inflation) below which things push the band: 0.5 m.
inline constexpr float kBandReach = 5.0F;
/// From the start field. Up to 256 cells a side 99.9 % of cells or more then pick the exact field's best neighbour.
/// (Six take longer than 100 plain sweeps where eight lanes are the most.) On larger windows fewer do, for the time
/// they take: what is lacking the submissions that follow find, each from the last one's field.
[[nodiscard]] constexpr Cycles cold_cycles(Grid grid) {
  if (grid.side > kLargeSide) return {2, 2};
  return grid.side > 256 ? Cycles{3, 4} : Cycles{3, 5};
}
/// From the last submission's field: one where nothing has changed since, a second where the first has found something
/// (docs/explanation/algorithm.md).
inline constexpr Cycles kWarmCycles{1, 2};

/// Times that pits are lifted at most, and before the certificate is read again. A pit that rounding has made is a
/// plateau a few cells wide; one that is deeper needs another solution.
inline constexpr std::int32_t kLifts = 32, kLiftsAtOnce = 4;

/// From the host's memory to the stages' or back, where these are two.
template <class T, class Executor>
void copy(Executor& executor, std::int32_t n, const T* from, T* to) noexcept {
  if constexpr (requires { executor.copy(n, from, to); }) executor.copy(n, from, to);
}

/// Warps, predicts, marks. The host has written walls into `occupants`, and `movers`.
struct MarkOrder {
  FieldArrays a;
  Grid grid;
  Warping warping;
  std::int32_t movers;

  template <class Executor>
  void operator()(Executor& executor) const noexcept {
    copy(executor, grid.cells(), a.shown.occupants, a.occupants);
    copy(executor, movers, a.shown.movers, a.movers);
    executor.for_each_cell(grid.side, grid.side, WarpOfEachCell{grid, warping, a.warp});
    executor.for_each(movers, PredictEachMover{grid, warping, a.warp, a.movers, a.marks});
    const std::int32_t cells = cells_of_row<Executor>(grid.side);
    executor.for_each_cell(grid.side / cells, grid.side,
                           MarkRow{grid, cells, warping, a.warp, a.movers, a.marks, movers, a.occupants});
    copy(executor, grid.cells(), a.occupants, a.shown.occupants);
    copy(executor, movers, a.marks, a.shown.marks);
  }
};

/// Clearance from the occupants in `wanted`; only the lowest width x height cells count.
struct ClearOrder {
  FieldArrays a;
  Grid grid;
  std::int32_t width, height;
  float inflation;
  std::uint8_t wanted;

  template <class Executor>
  void operator()(Executor& executor) const noexcept {
    copy(executor, grid.cells(), a.shown.occupants, a.occupants);
    clear(executor);
  }

  /// The same where the stages have the occupants already.
  template <class Executor>
  void clear(Executor& executor) const noexcept {
    constexpr std::int32_t kColumns = Executor::kColumns;
    const std::int32_t side = grid.side;
    if constexpr (kColumns == kOneCell) {
      executor.for_each_cell(side, side / kRowsOfWord, OccupiedInColumn{grid, a.occupants, wanted, a.columns});
      executor.for_each_cell(side, side, NearestInColumn{grid, a.columns, a.rows_away});
      executor.for_each_cell(side, side, ClearanceOfCell{grid, width, height, a.rows_away, inflation, a.clearance});
    } else {
      executor.for_each(side / kColumns, NearestInColumns{grid, kColumns, a.occupants, wanted, a.rows_away});
      executor.for_each(side, rows(a.rows_away));
    }
    copy(executor, grid.cells(), a.clearance, a.shown.clearance);
  }

  [[nodiscard]] JAYWALK_CELL ClearanceOfRow rows(const std::int32_t* rows_away) const {
    return {grid, width, height, rows_away, inflation, a.envelope, a.stretch, a.clearance};
  }
};

struct MarkAndClearOrder {
  MarkOrder mark;
  ClearOrder clear;

  template <class Executor>
  void operator()(Executor& executor) const noexcept {
    mark(executor);
    clear.clear(executor);
  }
};

/// The start field, in `cost` and `start_psi`, by sweeps or as a crew settles it.
struct StartOrder {
  FieldArrays a;
  Grid grid;
  std::int32_t goal;

  template <class Executor>
  void operator()(Executor& executor) const noexcept {
    if constexpr (requires { executor.settle(grid, goal, a); }) {
      executor.settle(grid, goal, a);
    } else {
      rate(executor);
      executor.for_each(grid.cells(), FarFromGoal{goal, a.cost});
      while (!sweep(executor)) {
      }
    }
    carry_over(executor);
  }

  /// Its first and its last step, for a host that settles costs otherwise.
  template <class Executor>
  void rate(Executor& executor) const noexcept {
    executor.for_each_cell(grid.side, grid.side, RateOfEachCell{grid, a.clearance, a.table, a.rate});
  }
  template <class Executor>
  void carry_over(Executor& executor) const noexcept {
    executor.for_each(grid.cells(), PsiOfCost{a.rate, a.cost, a.start_psi});
  }

 private:
  /// Whether nothing has changed.
  template <class Executor>
  bool sweep(Executor& executor) const noexcept {
    const std::int32_t side = grid.side, cells = cells_of_row<Executor>(side), pieces = side / cells;
    const Along directions[] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (const Along along : directions) {
      for (std::int32_t odd = 0; odd < 2; ++odd) {
        executor.for_each_cell(side, (pieces + 1 - odd) / 2,
                               SweepPiece{grid, along, odd, cells, a.rate, a.cost, a.changed});
      }
    }
    return executor.total(side * pieces, a.changed).cells == 0;
  }
};

/// From clearance or the start field to the potential and its index matrix. Whatever breaks the certificate is not
/// used: a solution from the last gives way to one from the start field, that to one with twice the cycles, and that to
/// the start field itself.
struct SolveOrder {
  StartOrder begin;
  bool is_started;  ///< the start field is there already
  MultigridArrays levels;
  From from;
  Disc robot;  ///< where the path is to begin
  float *psi, *shown_psi;
  FieldQuality* found;

  template <class Executor>
  void operator()(Executor& executor) const noexcept {
    if (!is_started) begin(executor);
    FieldQuality quality;
    quality.done = true;
    if (has_joined(executor)) solve(executor, quality);
    *found = quality;
  }

 private:
  struct Attempt {
    From from;
    bool anew;  ///< from the start field, not from what the attempt before came to
    Cycles cycles;
    std::int32_t lifts;
  };

  /// Whether the goal can be reached from near the robot.
  template <class Executor>
  bool has_joined(Executor& executor) const noexcept {
    const std::int32_t first = robot.first_row(), last = robot.last_row(begin.grid);
    const std::int32_t rows = last < first ? 0 : last - first + 1;
    executor.for_each(rows, JoinedOfDisc{begin.grid, robot, begin.a.start_psi, begin.a.pits});
    return executor.total(rows, begin.a.pits).cells > 0;
  }

  template <class Executor>
  void solve(Executor& executor, FieldQuality& quality) const noexcept {
    const FieldArrays& a = begin.a;
    const Cycles cold = cold_cycles(begin.grid);
    const Attempt attempts[] = {{From::kLast, false, kWarmCycles, kLifts},
                                {From::kNothing, true, cold, kLifts},
                                {From::kNothing, false, {cold.most, cold.most}, kLifts},
                                {From::kStartOnly, true, {0, 0}, 2 * begin.grid.side}};
    for (const Attempt& attempt : attempts) {
      if (attempt.from < from || quality.certified) continue;
      if (attempt.anew) executor.for_each(begin.grid.cells(), Fill<float>{a.correction, 0.0F});
      quality.cycles += improve(executor, attempt);
      lift(executor, attempt.lifts, quality);
    }
    copy(executor, begin.grid.cells(), a.index, a.shown.index);
    copy(executor, begin.grid.cells(), psi, shown_psi);
  }

  template <class Executor>
  std::int32_t improve(Executor& executor, const Attempt& attempt) const noexcept {
    const FieldArrays& a = begin.a;
    const Grid grid = begin.grid;
    const std::int32_t cells = cells_of_row<Executor>(grid.side);
    return Multigrid<Executor>(executor, levels)
        .improve(grid, begin.goal, psi, attempt.cycles,
                 RowStep{grid.side, AddCorrection{grid, a.start_psi, a.correction, psi}},
                 RowStep{grid.side / cells, PitsOfRow{grid, begin.goal, cells, psi, a.pits}},
                 RowStep{grid.side, KeepCorrection{grid, a.start_psi, psi, a.correction}},
                 RowStep{grid.side, IndexOfEachCell{grid, psi, a.index}});
  }

  /// Reads the certificate; where there are pits, lifts them up to `most` times over, and keeps what that came to.
  template <class Executor>
  void lift(Executor& executor, std::int32_t most, FieldQuality& quality) const noexcept {
    read_certificate(executor, quality);
    if (quality.certified) return;
    const FieldArrays& a = begin.a;
    const Grid grid = begin.grid;
    const std::int32_t goal = begin.goal, cells = cells_of_row<Executor>(grid.side);
    for (std::int32_t lifts = 0; !quality.certified && lifts < most; lifts += kLiftsAtOnce) {
      for (std::int32_t k = 1; k <= kLiftsAtOnce; ++k) {
        executor.for_each_row(grid.side, RowStep{1, LiftPitsOfRow{grid, 0, goal, 2 * k - 1, cells, a.pits, psi}},
                              RowStep{1, LiftPitsOfRow{grid, 1, goal, 2 * k, cells, a.pits, psi}});
      }
      executor.for_each_cell(grid.side / cells, grid.side, PitsOfRow{grid, goal, cells, psi, a.pits});
      read_certificate(executor, quality);
    }
    executor.for_each_row(grid.side, RowStep{grid.side, KeepCorrection{grid, a.start_psi, psi, a.correction}},
                          RowStep{grid.side, IndexOfEachCell{grid, psi, a.index}});
  }

  template <class Executor>
  void read_certificate(Executor& executor, FieldQuality& quality) const noexcept {
    const std::int32_t side = begin.grid.side, width = side / cells_of_row<Executor>(side);
    const Counted pits = executor.total(side * width, begin.a.pits);
    quality.pits = pits.cells, quality.joined = pits.joined, quality.certified = pits.cells == 0;
  }
};

/// Pulls the band's `count` points taut; those before `first` and the last stay. The band is no longer than the raw
/// path: where what is near has made it so, tension alone draws it in, and where that takes too long, tension alone
/// acts on the raw path. Tension never lengthens: a point goes towards the middle of its neighbours. Steps are hundreds
/// of points or fewer: work for one block of threads.
struct PullInOneBlock {
  FieldArrays a;
  Grid grid;
  std::int32_t first, count;

  template <class Executor>
  JAYWALK_ORDER void operator()(Executor& executor) const noexcept {
    executor.for_each(count, Copy<cell::Point>{a.points, a.raw_points});
    executor.for_each(count, BeginBand{a.raw_points, a.points, a.moved});
    measure(executor, a.lengths);
    std::int32_t step = 0;
    drag(executor, kBandReach, kBandRounds, step, step);
    bool longer = is_longer(executor);
    for (std::int32_t r = 0, begun = step; r < kBandRounds && longer; r += kTautRounds) {
      drag(executor, 0.0F, kTautRounds, begun, step);
      longer = is_longer(executor);
    }
    if (longer) {
      executor.for_each(count, BeginBand{a.raw_points, a.points, a.moved});
      drag(executor, 0.0F, kBandRounds, step, step);
    }
  }

 private:
  /// Some rounds, from `step` on, of a force that began to act at step `begun`.
  template <class Executor>
  JAYWALK_APART void drag(Executor& executor, float reach, std::int32_t rounds, std::int32_t begun,
                          std::int32_t& step) const noexcept {
    for (const std::int32_t end = step + 3 * rounds; step < end; ++step) {
      const std::int32_t from = first + step % 3;
      executor.for_each((count - from + 1) / 3,
                        PullBand{grid, from, count, a.clearance, reach, begun, step, a.points, a.moved});
    }
  }

  template <class Executor>
  JAYWALK_ORDER void measure(Executor& executor, double* length) const noexcept {
    executor.for_each(count - 1, LengthOfSegment{a.points, a.segments});
    executor.for_each(1, LengthOfBand{count - 1, a.segments, length});
  }

  /// Than the raw path.
  template <class Executor>
  JAYWALK_ORDER bool is_longer(Executor& executor) const noexcept {
    measure(executor, a.lengths + 1);
    return a.lengths[1] > a.lengths[0];
  }
};

struct PullOrder {
  PullInOneBlock pull;

  template <class Executor>
  void operator()(Executor& executor) const noexcept {
    copy(executor, pull.count, pull.a.shown.points, pull.a.points);
    executor.in_one_block(pull);
    copy(executor, pull.count, pull.a.points, pull.a.shown.points);
  }
};

}  // namespace jaywalk::field
