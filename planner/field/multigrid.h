#pragma once
// Solves the rebased potential by V-cycles over blocks of 2 x 2. Order only; no formula lives here.
#include <array>
#include <cstddef>
#include <vector>

#include "planner/field/coarse_stages.h"
#include "planner/field/executor.h"
#include "planner/field/potential_stages.h"

namespace jaywalk::field {

template <class Executor>
class Multigrid {
 public:
  /// Takes memory for grids up to `max_side` cells, a power of two times kCoarsestSide or more.
  Multigrid(Executor& executor, std::int32_t max_side) : executor_(executor) {
    for (std::int32_t side = max_side; side >= kCoarsestSide; side /= 2) arrays_.push_back(take_level(side));
    executor_.for_each(Board{max_side}.size(), Fill<float>{arrays_[0].diagonal, 1.0F});
    counted_ = executor_.template take<std::int32_t>(static_cast<std::size_t>(max_side));
    joined_ = executor_.template take<std::int32_t>(static_cast<std::size_t>(max_side));
    executor_.wait();
  }

  /// Improves the estimate that the step `first` leaves in psi (by rows; cell::kUnreachable and cell::kNotFree where
  /// that is so) by `least` cycles or more, until one has found hardly anything new, at most `most`; the steps `last`
  /// then visit the result. Returns how many. Blocks are weighted afresh each time: with the weights of the cycle
  /// before, the second makes things worse.
  template <class First, class... Last>
  std::int32_t improve(Grid grid, std::int32_t goal, float* psi, std::int32_t least, std::int32_t most,
                       const First& first, const Last&... last) noexcept {
    const Board board{grid.side};
    const Arrays& a = arrays_[0];
    set_up(board, goal, psi, first);
    levels_ = arrays_.size();
    std::int32_t cycles = 0;
    for (bool enough = least == 0; !enough;) {
      cycle(board, 0, cycles == 0);
      enough = ++cycles >= least && (cycles >= most || is_settled(board));
    }
    executor_.for_each_row(board.side, RowStep{board.half(), RebasePsi{board, 0, a.x, a.psi}},
                           RowStep{board.half(), RebasePsi{board, 1, a.x, a.psi}},
                           RowStep{board.half(), FromBoard{board, a.psi, psi}}, last...);
    return cycles;
  }

 private:
  static constexpr std::int32_t kCoarsestSide = 4;
  static constexpr std::int32_t kCoarsestSweeps = 8;  ///< settles 4 x 4 blocks
  /// Further sweeps after a correction, by depth; even numbers. Blocks of 8 cells are the largest that still tell the
  /// two sides of an ordinary wall apart; a level's error leaves a long corridor along them, a block or two a sweep,
  /// and they are few. Blocks of 2 and 4 tell those of a thin one apart. Numbers by trial on random maps
  /// (docs/performance.md).
  static constexpr std::array<std::int32_t, 4> kFurtherSweeps{0, 6, 24, 64};
  /// Of the blocks below that have an equation, those that a level above these speaks for, at least, where it is used.
  /// (Open ground, rooms, boxes: 0.85 to 1. Corridors of 1.5 m: 0.78, with 0.5 on the next level.)
  static constexpr float kSpokenShare = 0.8F;
  /// A cycle that has tilted less than a 128th of the cells by more than a hundredth has found their directions: the
  /// next would tilt a tenth of that, and 99.9 % of cells and more pick the exact field's best neighbour
  /// (potential_test).
  static constexpr float kTilt = 0.01F;
  static constexpr std::int32_t kSettledShare = 128;

  /// A level's memory. The last two only blocks have a use for.
  struct Arrays {
    CouplingArrays couplings;
    float *psi, *diagonal, *source, *x;
    BlockRows rows;
    float* correction;  ///< by rows
  };

  Arrays take_level(std::int32_t side) {
    const auto board = [&] { return executor_.template take<float>(static_cast<std::size_t>(Board{side}.size())); };
    const auto rows = [&] { return take_rows<float>(executor_, side); };
    Arrays a{{board(), board(), board(), board()}, board(), board(), board(), board(), {}, nullptr};
    if (arrays_.empty()) return a;
    a.rows = {{rows(), rows(), rows(), rows()},        rows(), rows(), rows(), rows(), rows(), rows(), rows(),
              take_rows<std::int32_t>(executor_, side)};
    a.correction = rows();
    return a;
  }

  template <class First>
  void set_up(Board board, std::int32_t goal, const float* psi, const First& first) noexcept {
    const Arrays& a = arrays_[0];
    const std::int32_t half = board.half();
    executor_.for_each_row(board.side, first, RowStep{half, ToBoard{board, psi, a.psi}},
                           RowStep{half, CoupleAhead{board, 0, a.psi, a.couplings, a.source, a.x}},
                           RowStep{half, CoupleAhead{board, 1, a.psi, a.couplings, a.source, a.x}},
                           RowStep{half, CoupleBack{board, 0, a.couplings}},
                           RowStep{half, CoupleBack{board, 1, a.couplings}});
    executor_.for_each(1, SettleGoal{board, goal, a.couplings, a.source});
  }

  /// One V-cycle from this level down and back. The first finds out which levels are of use; the others carry over what
  /// the one before has found.
  void cycle(Board board, std::size_t depth, bool first) noexcept {
    if (board.side <= kCoarsestSide) {
      relax(board, arrays_[depth], kCoarsestSweeps);
      return;
    }
    const Board blocks{board.side / 2};
    go_down(board, depth, depth == 0 && !first);
    if (first && depth + 1 >= kFurtherSweeps.size() && !speaks_for_most(blocks, depth + 1)) levels_ = depth + 1;
    if (depth + 1 < levels_) {
      cycle(blocks, depth + 1, first);
      depth == 0 ? go_up<true>(board, depth) : go_up<false>(board, depth);
    }
    if (depth < kFurtherSweeps.size()) relax(board, arrays_[depth], kFurtherSweeps[depth]);
  }

  static RowStep<RelaxColour> relax(Board board, std::int32_t colour, const Arrays& a) {
    return {board.half(), {board, colour, a.couplings, a.source, a.x}};
  }

  /// Two sweeps a round: what the first has fetched is at hand for the second.
  void relax(Board board, const Arrays& a, std::int32_t sweeps) noexcept {
    executor_.repeat(sweeps / 2, board.side, relax(board, 0, a), relax(board, 1, a), relax(board, 0, a),
                     relax(board, 1, a));
  }

  /// Builds the blocks, relaxes twice, and hands on what is lacking.
  void go_down(Board board, std::size_t depth, bool rebase) noexcept {
    const Arrays& a = arrays_[depth];
    const Arrays& b = arrays_[depth + 1];
    const Board blocks{board.side / 2};
    const Level level{board, a.couplings, a.psi, a.diagonal};
    const std::int32_t rebased = rebase ? board.half() : 0;
    executor_.for_each_row(board.side, RowStep{rebased, RebaseCouplings{board, 0, a.x, a.couplings, a.source}},
                           RowStep{rebased, RebaseCouplings{board, 1, a.x, a.couplings, a.source}},
                           RowStep{rebased, RebasePsi{board, 0, a.x, a.psi}},
                           RowStep{rebased, RebasePsi{board, 1, a.x, a.psi}},
                           RowStep{blocks.side, CoarsenBlock{level, blocks.side, b.rows}, 2},
                           RowStep{blocks.half(), BlocksToBoard{blocks, b.rows, b.couplings, b.psi, b.diagonal}, 2},
                           relax(board, 0, a), relax(board, 1, a), relax(board, 0, a), relax(board, 1, a),
                           RowStep{blocks.side, RestrictToBlock{level, a.source, a.x, blocks.side, b.rows}, 2},
                           RowStep{blocks.half(), LackingToBoard{blocks, b.rows.lacking, b.source, b.x}, 2});
  }

  /// Adds what the blocks have found, and relaxes twice.
  template <bool kFinest>
  void go_up(Board board, std::size_t depth) noexcept {
    const Arrays& a = arrays_[depth];
    const Arrays& b = arrays_[depth + 1];
    const Board blocks{board.side / 2};
    const auto prolong = [&](std::int32_t colour) {
      return RowStep<ProlongToCell<kFinest>>{
          board.half(),
          {blocks.side, b.rows.members, b.rows.open_east, b.rows.open_north, b.correction, board, colour, a.x}};
    };
    executor_.for_each_cell(blocks.half(), blocks.side, FromBoard{blocks, b.x, b.correction});
    executor_.for_each_row(board.side, prolong(0), prolong(1), relax(board, 0, a), relax(board, 1, a),
                           relax(board, 0, a), relax(board, 1, a));
  }

  /// Whether this level's blocks speak for enough of those below. Large ones in narrow passages do not: they lie across
  /// walls, and what they find for one passage is wrong in the next. It and all above it are then left out.
  bool speaks_for_most(Board board, std::size_t depth) noexcept {
    const Counted spoken = count(board.side, SpokenOfRow{board.side, arrays_[depth - 1].rows.diagonal,
                                                         arrays_[depth].rows.members, counted_, joined_});
    return static_cast<float>(spoken.cells) >= kSpokenShare * static_cast<float>(spoken.joined);
  }

  /// Whether the last cycle has found hardly anything new.
  bool is_settled(Board board) noexcept {
    const Counted tilted = count(board.side, TiltedOfRow{board, kTilt, arrays_[0].x, counted_, joined_});
    return kSettledShare * tilted.cells <= tilted.joined;
  }

  struct Counted {
    std::int32_t cells = 0, joined = 0;
  };

  /// The sums over rows of what a stage counts in each; none where the executor has failed.
  template <class Stage>
  Counted count(std::int32_t rows, const Stage& stage) noexcept {
    executor_.for_each_cell(1, rows, stage);
    Counted sum;
    if (!executor_.wait()) return sum;
    for (std::int32_t row = 0; row < rows; ++row) sum.cells += counted_[row], sum.joined += joined_[row];
    return sum;
  }

  Executor& executor_;
  std::vector<Arrays> arrays_;       ///< finest first
  std::size_t levels_ = 0;           ///< of these that are of use on this map
  std::int32_t *counted_, *joined_;  ///< by the finest board's rows
};

}  // namespace jaywalk::field
