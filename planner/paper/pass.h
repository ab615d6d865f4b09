#pragma once
// A plan's steps: marks and clearance, start field, solution. Between them the host chooses goal and start.
#include <optional>

#include "planner/mapping/window.h"
#include "planner/paper/map_field.h"
#include "planner/paper/mark_stages.h"
#include "planner/paper/multigrid.h"
#include "planner/paper/start_field.h"
#include "planner/tracking/track.h"

namespace jaywalk::paper {
using field::kNoCell;
using field::nearest_cell;

/// Start of a solution.
enum class From : std::uint8_t {
  kLast,       ///< the last one, which must have been on the same cells with the same goal
  kNothing,    ///< the start field
  kStartOnly,  ///< the start field, and leave it at that
};

/// Cycles of a solution from the start field. Up to 256 cells a side 99.9 % of cells or more then pick the exact
/// field's best neighbour. On larger windows fewer do: the submissions that follow find the rest.
[[nodiscard]] constexpr Cycles cold_cycles(Grid grid) {
  if (grid.side > kLargeSide) return {2, 2};
  return grid.side > 256 ? Cycles{3, 4} : Cycles{3, 5};
}
/// Cycles from the last submission's field; the second where the first has found more (docs/explanation/algorithm.md).
inline constexpr Cycles kWarmCycles{1, 2};

/// Cells within `radius` of (i, j).
struct Disc {
  std::int32_t i, j, radius;
};

/// Arrays that stages and host both read and write, by cells, by movers.
struct FieldArrays {
  std::uint8_t *occupants, *index;
  Mover* movers;
  Mark* marks;
  float *clearance, *start_psi, *psi;
};

/// The stages on one executor, and their memory. False, or a quality that is not `done`: the executor has failed.
template <class Executor>
class Pass {
 public:
  Pass(Executor& executor, std::int32_t max_side)
      : executor_(executor),
        correction_(take<float>(max_side)),
        rows_away_(take<std::int32_t>(max_side)),
        envelope_(take<std::int32_t>(max_side)),
        stretch_(take<std::int32_t>(max_side)),
        pits_(executor.template take<Counted>(static_cast<std::size_t>(max_side))),
        start_(max_side) {
    const auto cells = static_cast<std::size_t>(Grid{max_side}.cells());
    stages_.psi = take_rows<float>(executor, max_side);
    host_.psi = executor.show(stages_.psi, cells);
    share(&FieldArrays::occupants, cells), share(&FieldArrays::index, cells);
    share(&FieldArrays::movers, kMaxTracks), share(&FieldArrays::marks, kMaxTracks);
    share(&FieldArrays::clearance, cells), share(&FieldArrays::start_psi, cells);
    multigrid_.emplace(executor, max_side, stages_.psi);
  }

  /// The host's, between calls.
  [[nodiscard]] const FieldArrays& shown() const noexcept { return host_; }

  /// Warps, predicts, marks. The host has written walls into `occupants`, and `movers`.
  bool mark(Grid grid, const Warping& warping, std::int32_t count) noexcept {
    if (!executor_.begin()) return false;
    executor_.copy(grid.cells(), host_.occupants, stages_.occupants);
    executor_.copy(count, host_.movers, stages_.movers);
    executor_.for_each_cell(count, 1, PredictEachMover{grid, warping, stages_.movers, stages_.marks});
    executor_.for_each_cell(grid.side, grid.side, MarkEachCell{grid, stages_.marks, count, stages_.occupants});
    executor_.copy(grid.cells(), stages_.occupants, host_.occupants);
    executor_.copy(count, stages_.marks, host_.marks);
    return executor_.end();
  }

  /// Clearance from the occupants in `wanted`, which the host has written or mark() has left.
  bool clear(Grid grid, float inflation, std::uint8_t wanted) noexcept {
    return clear(grid, grid.side, grid.side, inflation, wanted);
  }
  /// Clearance of the lowest width x height cells alone.
  bool clear(Grid grid, std::int32_t width, std::int32_t height, float inflation, std::uint8_t wanted) noexcept {
    started_ = kNoCell;
    if (!executor_.begin()) return false;
    executor_.copy(grid.cells(), host_.occupants, stages_.occupants);
    executor_.for_each_cell(grid.side / NearestInColumns::kColumns, 1,
                            NearestInColumns{grid, stages_.occupants, wanted, rows_away_});
    executor_.for_each_cell(
        grid.side, 1,
        ClearanceOfRow{grid, width, height, rows_away_, inflation, envelope_, stretch_, stages_.clearance});
    executor_.copy(grid.cells(), stages_.clearance, host_.clearance);
    return executor_.end();
  }

  /// The start field, by the host, unless it is there.
  bool start(Grid grid, std::int32_t goal) noexcept {
    if (started_ != goal) started_ = start_.settle(grid, goal, host_.clearance, host_.start_psi) ? goal : kNoCell;
    return started_ == goal;
  }

  /// Solves the potential and its index matrix from the clearance, if the goal can be reached from near the robot.
  FieldQuality solve(Grid grid, std::int32_t goal, From from, const Disc& robot) noexcept {
    const auto is_joined = [this](std::int32_t c) { return cell::is_joined(host_.start_psi[c]); };
    FieldQuality quality;
    if (!start(grid, goal)) return quality;
    quality.done = true;
    if (nearest_cell(grid, robot.i, robot.j, robot.radius, is_joined) == kNoCell) return quality;
    if (!executor_.begin()) return {};
    executor_.copy(grid.cells(), host_.start_psi, stages_.start_psi);
    solve_from(grid, goal, from, quality);
    executor_.for_each_cell(grid.side, grid.side, IndexOfEachCell{grid, stages_.psi, stages_.index});
    executor_.copy(grid.cells(), stages_.index, host_.index);
    executor_.copy(grid.cells(), stages_.psi, host_.psi);
    return executor_.end() ? quality : FieldQuality{};
  }
  FieldQuality solve(Grid grid, std::int32_t goal, From from) noexcept {
    return solve(grid, goal, from, {goal % grid.side, goal / grid.side, 0});
  }

 private:
  /// Times that pits are lifted at most, and before the certificate is read again. A pit that rounding has made is a
  /// plateau a few cells wide; one that is deeper needs another solution.
  static constexpr std::int32_t kLifts = 32, kLiftsAtOnce = 4;

  struct Attempt {
    From from;
    bool anew;  ///< from the start field, not from what the attempt before came to
    Cycles cycles;
    std::int32_t lifts;
  };

  template <class T>
  T* take(std::int32_t side) {
    return executor_.template take<T>(static_cast<std::size_t>(Grid{side}.cells()));
  }
  template <class T>
  void share(T* FieldArrays::*array, std::size_t n) {
    stages_.*array = executor_.template take<T>(n);
    host_.*array = executor_.show(stages_.*array, n);
  }

  /// Whatever breaks the certificate is not used: a solution from the last gives way to one from the start field, that
  /// to one with twice the cycles, and that to the start field itself.
  void solve_from(Grid grid, std::int32_t goal, From from, FieldQuality& quality) noexcept {
    const Cycles cold = cold_cycles(grid);
    const Attempt attempts[] = {{From::kLast, false, kWarmCycles, kLifts},
                                {From::kNothing, true, cold, kLifts},
                                {From::kNothing, false, {cold.most, cold.most}, kLifts},
                                {From::kStartOnly, true, {0, 0}, 2 * grid.side}};
    for (const Attempt& attempt : attempts) {
      if (attempt.from < from || quality.certified) continue;
      if (attempt.anew) executor_.for_each_cell(grid.cells(), 1, Fill<float>{correction_, 0.0F});
      executor_.for_each_cell(grid.cells(), 1, AddCorrection{stages_.start_psi, correction_, stages_.psi});
      quality.cycles += multigrid_->improve(grid, goal, attempt.cycles);
      read_certificate(grid, goal, quality);
      for (std::int32_t lifts = 0; !quality.certified && lifts < attempt.lifts; lifts += kLiftsAtOnce) {
        for (std::int32_t k = 0; k < 2 * kLiftsAtOnce; ++k)
          executor_.for_each_cell(grid.side, grid.side, LiftPits{grid, k & 1, goal, stages_.psi});
        read_certificate(grid, goal, quality);
      }
      executor_.for_each_cell(grid.cells(), 1, KeepCorrection{stages_.start_psi, stages_.psi, correction_});
    }
  }

  void read_certificate(Grid grid, std::int32_t goal, FieldQuality& quality) noexcept {
    executor_.for_each_cell(grid.side, 1, PitsOfRow{grid, goal, stages_.psi, pits_});
    const Counted pits = executor_.total(grid.side, pits_);
    quality.pits = pits.cells, quality.joined = pits.joined, quality.certified = pits.cells == 0;
  }

  Executor& executor_;
  FieldArrays stages_{}, host_{};
  float* correction_;
  std::int32_t *rows_away_, *envelope_, *stretch_;
  Counted* pits_;
  StartField start_;
  std::int32_t started_ = kNoCell;  ///< goal of the start field that belongs to the clearance
  std::optional<Multigrid<Executor>> multigrid_;
};

}  // namespace jaywalk::paper
