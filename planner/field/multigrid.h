#pragma once
// Solves the rebased potential by V-cycles over blocks of 2 x 2. Order only; no formula lives here.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "planner/field/coarse_stages.h"
#include "planner/field/potential_stages.h"

namespace jaywalk::field {

template <class Executor>
class Multigrid {
 public:
  /// Takes memory for grids up to `max_side` cells, a power of two times kCoarsestSide or more.
  Multigrid(Executor& executor, std::int32_t max_side) : executor_(executor) {
    for (std::int32_t side = max_side; side >= kCoarsestSide; side /= 2) arrays_.push_back(take_level(side));
    executor_.for_each(Board{max_side}.size(), Fill<float>{arrays_[0].diagonal, 1.0F});
    farthest_ = executor_.template take<float>(static_cast<std::size_t>(Board{max_side}.rows()));
    executor_.wait();
  }

  /// Improves psi (by rows), an estimate with cell::kUnreachable and cell::kNotFree where that is so, by `least` cycles
  /// or more, until one has moved nothing much, at most `most`. Returns how many. Blocks are weighted afresh each
  /// time: with the weights of the cycle before, the second makes things worse.
  std::int32_t improve(Grid grid, std::int32_t goal, float* psi, std::int32_t least, std::int32_t most) noexcept {
    const Board board{grid.side};
    set_up(board, goal, psi);
    Arrays& a = arrays_[0];
    std::int32_t cycles = 0;
    for (bool enough = least == 0; !enough;) {
      coarsen(board);
      cycle(board, 0);
      enough = ++cycles >= least && (cycles >= most || is_settled(board));
      if (!enough) {
        both(board, [&](std::int32_t colour) { return RebaseCouplings{board, colour, a.x, a.couplings, a.source}; });
      }
      executor_.for_each(board.size(), RebasePsi{a.x, a.psi});
    }
    executor_.for_each_cell(grid.side, grid.side, PsiFromBoard{board, a.psi, psi});
    return cycles;
  }

 private:
  static constexpr std::int32_t kCoarsestSide = 4;
  static constexpr std::int32_t kSweeps = 2;          ///< before and after each correction
  static constexpr std::int32_t kCoarsestSweeps = 8;  ///< settles 4 x 4 blocks
  /// A cycle that has changed no cell by more than this share has found its directions: 99.9 % of cells and more pick
  /// the exact field's best neighbour (potential_test).
  static constexpr float kSettled = 0.02F;

  /// A level's memory; the second and third line only blocks have a use for, on their way to finer cells.
  struct Arrays {
    CouplingArrays couplings;
    float *psi, *diagonal, *source, *x;
    float *low_weight, *high_weight;
    float *open_east, *open_north, *correction;
  };

  float* take_board(std::int32_t side) {
    return executor_.template take<float>(static_cast<std::size_t>(Board{side}.size()));
  }
  Arrays take_level(std::int32_t side) {
    const auto board = [&] { return take_board(side); };
    const auto rows = [&] { return take_rows<float>(executor_, side); };
    return {{board(), board(), board(), board()},
            board(),
            board(),
            board(),
            board(),
            board(),
            board(),
            rows(),
            rows(),
            rows()};
  }

  /// Visits all cells of a board, even ones first, with the stage that `stage_for` makes for a colour.
  template <class StageFor>
  void both(Board board, const StageFor& stage_for) noexcept {
    for (std::int32_t colour = 0; colour < 2; ++colour) {
      executor_.for_each_cell(board.half(), board.side, stage_for(colour));
    }
  }

  [[nodiscard]] Level level(Board board, std::size_t depth) const noexcept {
    const Arrays& a = arrays_[depth];
    return {board, a.couplings, a.psi, a.diagonal};
  }

  [[nodiscard]] static bool is_coarsest(Board board) noexcept { return board.side <= kCoarsestSide; }

  void set_up(Board board, std::int32_t goal, const float* psi) noexcept {
    Arrays& a = arrays_[0];
    both(board, [&](std::int32_t colour) { return PsiToBoard{board, colour, psi, a.psi}; });
    both(board, [&](std::int32_t colour) { return CoupleAhead{board, colour, a.psi, a.couplings, a.source, a.x}; });
    both(board, [&](std::int32_t colour) { return CoupleBack{board, colour, a.couplings}; });
    executor_.for_each(1, SettleGoal{board, goal, a.couplings, a.source});
  }

  void coarsen(Board board) noexcept {
    for (std::size_t depth = 0; !is_coarsest(board); ++depth) {
      const Board blocks{board.side / 2};
      Arrays& b = arrays_[depth + 1];
      both(blocks, [&](std::int32_t colour) {
        return CoarsenBlock{level(board, depth), blocks,       colour,       b.couplings, b.psi,
                            b.diagonal,          b.low_weight, b.high_weight};
      });
      executor_.for_each_cell(blocks.side, blocks.side, OpenFaces{blocks, b.couplings, b.open_east, b.open_north});
      board = blocks;
    }
  }

  /// Whether the last cycle has left all v near 1.
  bool is_settled(Board board) noexcept {
    executor_.for_each(board.rows(), FarthestOfRow{board, arrays_[0].x, farthest_});
    if (!executor_.wait()) return true;
    float farthest = 0.0F;
    for (std::int32_t row = 0; row < board.rows(); ++row) farthest = std::max(farthest, farthest_[row]);
    return farthest <= kSettled;
  }

  void relax(Board board, Arrays& a, std::int32_t sweeps) noexcept {
    for (std::int32_t k = 0; k < sweeps; ++k) {
      both(board, [&](std::int32_t colour) { return RelaxColour{board, colour, a.couplings, a.source, a.x}; });
    }
  }

  template <bool kFinest>
  void prolong(Board board, Arrays& a, const Arrays& b) noexcept {
    both(board, [&](std::int32_t colour) {
      return ProlongToCell<kFinest>{board.side / 2, b.open_east, b.open_north, b.correction, board, colour, a.x};
    });
  }

  void cycle(Board board, std::size_t depth) noexcept {
    Arrays& a = arrays_[depth];
    if (is_coarsest(board)) {
      relax(board, a, kCoarsestSweeps);
      return;
    }
    const Board blocks{board.side / 2};
    Arrays& b = arrays_[depth + 1];
    relax(board, a, kSweeps);
    both(blocks, [&](std::int32_t colour) {
      return RestrictToBlock{level(board, depth), a.source,      a.x,      blocks, colour,
                             b.low_weight,        b.high_weight, b.source, b.x};
    });
    cycle(blocks, depth + 1);
    executor_.for_each_cell(blocks.side, blocks.side, CorrectionByRows{blocks, b.x, b.correction});
    depth == 0 ? prolong<true>(board, a, b) : prolong<false>(board, a, b);
    relax(board, a, kSweeps);
  }

  Executor& executor_;
  std::vector<Arrays> arrays_;  ///< finest first
  float* farthest_;             ///< by the rows of the finest board
};

}  // namespace jaywalk::field
