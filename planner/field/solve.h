#pragma once
// From the start field to the potential and its index matrix.
#include "planner/field/field_arrays.h"
#include "planner/field/multigrid.h"

namespace jaywalk::field {

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

/// One solution. Whatever breaks the certificate is not used: a solution from the last gives way to one from the start
/// field, that to one with twice the cycles, and that to the start field itself.
template <class Executor>
class Solve {
 public:
  /// `psi` is the potential in the stages' memory; the start field is there already.
  Solve(Executor& executor, const MultigridArrays& levels, const FieldArrays& a, Grid grid, std::int32_t goal,
        float* psi)
      : executor_(executor), levels_(levels), a_(a), grid_(grid), goal_(goal), psi_(psi) {}

  /// Whether the goal can be reached from near the robot.
  [[nodiscard]] bool has_joined(const Disc& robot) noexcept {
    const std::int32_t first = robot.first_row(), last = robot.last_row(grid_);
    const std::int32_t rows = last < first ? 0 : last - first + 1;
    executor_.for_each(rows, JoinedOfDisc{grid_, robot, a_.start_psi, a_.pits});
    return executor_.total(rows, a_.pits).cells > 0;
  }

  FieldQuality begin_with(From from) noexcept {
    const Cycles cold = cold_cycles(grid_);
    const Attempt attempts[] = {{From::kLast, false, kWarmCycles, kLifts},
                                {From::kNothing, true, cold, kLifts},
                                {From::kNothing, false, {cold.most, cold.most}, kLifts},
                                {From::kStartOnly, true, {0, 0}, 2 * grid_.side}};
    FieldQuality quality;
    for (const Attempt& attempt : attempts) {
      if (attempt.from < from || quality.certified) continue;
      if (attempt.anew) executor_.for_each(grid_.cells(), Fill<float>{a_.correction, 0.0F});
      quality.cycles += improve(attempt.cycles);
      lift(attempt.lifts, quality);
    }
    return quality;
  }

 private:
  struct Attempt {
    From from;
    bool anew;  ///< from the start field, not from what the attempt before came to
    Cycles cycles;
    std::int32_t lifts;
  };

  [[nodiscard]] RowStep<KeepCorrection> correction_kept() const {
    return {grid_.side, {grid_, a_.start_psi, psi_, a_.correction}};
  }
  [[nodiscard]] RowStep<IndexOfEachCell> index_found() const { return {grid_.side, {grid_, psi_, a_.index}}; }
  [[nodiscard]] RowStep<PitsOfRow> pits_found() const {
    return {grid_.side / cells_, {grid_, goal_, cells_, psi_, a_.pits}};
  }

  std::int32_t improve(Cycles cycles) noexcept {
    return Multigrid<Executor>(executor_, levels_)
        .improve(grid_, goal_, psi_, cycles,
                 RowStep{grid_.side, AddCorrection{grid_, a_.start_psi, a_.correction, psi_}}, pits_found(),
                 correction_kept(), index_found());
  }

  /// Reads the certificate; where there are pits, lifts them up to `most` times over, and keeps what that came to.
  void lift(std::int32_t most, FieldQuality& quality) noexcept {
    read_certificate(quality);
    if (quality.certified) return;
    for (std::int32_t lifts = 0; !quality.certified && lifts < most; lifts += kLiftsAtOnce) {
      for (std::int32_t k = 1; k <= kLiftsAtOnce; ++k) {
        executor_.for_each_row(grid_.side, RowStep{1, LiftPitsOfRow{grid_, 0, goal_, 2 * k - 1, cells_, a_.pits, psi_}},
                               RowStep{1, LiftPitsOfRow{grid_, 1, goal_, 2 * k, cells_, a_.pits, psi_}});
      }
      executor_.for_each_row(grid_.side, pits_found());
      read_certificate(quality);
    }
    executor_.for_each_row(grid_.side, correction_kept(), index_found());
  }

  void read_certificate(FieldQuality& quality) noexcept {
    const Counted pits = executor_.total(grid_.side * (grid_.side / cells_), a_.pits);
    quality.pits = pits.cells, quality.joined = pits.joined, quality.certified = pits.cells == 0;
  }

  Executor& executor_;
  const MultigridArrays& levels_;
  const FieldArrays& a_;
  Grid grid_;
  std::int32_t goal_;
  float* psi_;
  std::int32_t cells_ = cells_of_row<Executor>(grid_.side);  ///< of a piece of a row
};

}  // namespace jaywalk::field
