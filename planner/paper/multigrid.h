#pragma once
// Solves the rebased potential by V-cycles over blocks of 2 x 2. Order only; no formula lives here.
#include "planner/paper/coarse_stages.h"

namespace jaywalk::paper {
inline constexpr std::int32_t kCoarsestSide = 4;
inline constexpr std::int32_t kMostLevels = 11;  ///< 4 to 4096 cells a side

/// Cells a side beyond which cycles cost more than they are worth in one plan: fewer, and blocks go down twice in each.
inline constexpr std::int32_t kLargeSide = 512;

struct Cycles {
  std::int32_t least, most;  ///< on from the least, until one has found hardly anything new
};

/// The order of a solution's stages.
template <class Executor>
class Multigrid {
 public:
  /// Memory for grids up to `max_side` cells, a power of two from kCoarsestSide on. `psi`: of cells (take_rows).
  Multigrid(Executor& executor, std::int32_t max_side, float* psi) : executor_(executor) {
    std::int32_t depth = 0;
    for (std::int32_t side = max_side; side >= kCoarsestSide; side /= 2, ++depth) take_level(depth, side, psi);
    counted_ = executor.template take<Counted>(static_cast<std::size_t>(max_side));
  }

  /// Improves psi (cell::kUnreachable and cell::kNotFree where that is so) by `least` cycles or more, until one has
  /// found hardly anything new, at most `most`. Returns how many. Blocks are weighted afresh each time: with the
  /// weights of the cycle before, the second makes things worse.
  std::int32_t improve(Grid grid, std::int32_t goal, Cycles wanted) noexcept {
    for (std::int32_t depth = 0, side = grid.side; side >= kCoarsestSide; ++depth, side /= 2)
      levels_[depth].grid.side = side;
    const Level& cells = levels_[0];
    for_each_cell(cells, CoupleAhead{cells});
    for_each_cell(cells, CoupleBack{cells});
    executor_.for_each_cell(1, 1, SettleGoal{cells, goal});
    std::int32_t cycles = 0;
    for (bool enough = wanted.least == 0; !enough;) {
      cycle(cycles == 0);
      enough = ++cycles >= wanted.least && (cycles >= wanted.most || is_settled());
    }
    executor_.for_each_cell(grid.cells(), 1, RebasePsi{cells.x, cells.psi});
    return cycles;
  }

 private:
  static constexpr std::int32_t kCoarsestSweeps = 8;  ///< settles 4 x 4 blocks
  static constexpr std::int32_t kBulkyDepth = 3;      ///< of the level with blocks 8 cells wide
  /// Least share of the blocks below, of those with an equation, for which a level in use speaks.
  /// (Open ground, rooms, boxes: 0.85 to 1. Corridors of 1.5 m: 0.78, with 0.5 on the next level.)
  static constexpr float kSpokenShare = 0.8F;
  /// A cycle that has tilted less than a 128th of the cells by more than a hundredth has found their directions: the
  /// next would tilt a tenth of that, and 99.9 % of cells and more pick the exact field's best neighbour
  /// (potential_test).
  static constexpr float kTilt = 0.01F;
  static constexpr std::int32_t kSettledShare = 128;

  /// Further sweeps after a correction, by depth. Blocks of 8 cells are the largest that still tell the two sides of an
  /// ordinary wall apart; a level's error leaves a long corridor along them, a block or two a sweep, and they are few.
  /// Blocks of 2 and 4 tell those of a thin one apart. Numbers by trial on random maps
  /// (docs/explanation/results.md#time).
  static constexpr std::int32_t further_sweeps(std::int32_t depth) {
    return depth == 1 ? 6 : (depth == 2 ? 24 : (depth == kBulkyDepth ? 64 : 0));
  }

  void take_level(std::int32_t depth, std::int32_t side, float* psi) {
    const auto take = [&]<class T>(T*& array) {
      array = executor_.template take<T>(static_cast<std::size_t>(Grid{side}.cells()));
    };
    Level& level = levels_[depth];
    for (float** array :
         {&level.couplings.east, &level.couplings.west, &level.couplings.north, &level.couplings.south, &level.source})
      take(*array);
    level.x = take_rows<float>(executor_, side);
    level.psi = psi;
    if (depth == 0) return;
    take(level.psi), take(level.diagonal), take(blocks_[depth].low_weight), take(blocks_[depth].high_weight);
    blocks_[depth].ties = take_rows<std::int32_t>(executor_, side);
  }

  template <class Stage>
  void for_each_cell(const Level& level, const Stage& stage) noexcept {
    executor_.for_each_cell(level.grid.side, level.grid.side, stage);
  }

  /// Down and back. The first cycle finds out which levels are of use; the others carry over what the one before has
  /// found. On a large grid blocks of 2 cells go down and back once more before the cells do, where blocks larger than
  /// 8 cells are of use: what is lacking there is smooth, and blocks are few.
  void cycle(bool first) noexcept {
    const Level& cells = levels_[0];
    if (first) used_ = kMostLevels;
    if (!first) {
      for_each_cell(cells, RebaseCouplings{cells});
      executor_.for_each_cell(cells.grid.cells(), 1, RebasePsi{cells.x, cells.psi});
    }
    std::int32_t depth = descend(0, first, true);
    if (cells.grid.side > kLargeSide && depth > kBulkyDepth) {
      climb(depth, 1);
      depth = descend(1, first, false);
    }
    climb(depth, 0);
  }

  /// Down to the lowest level of use, which is relaxed. `build`: the levels' equations, unless they are there. Returns
  /// the lowest level.
  std::int32_t descend(std::int32_t depth, bool first, bool build) noexcept {
    for (; levels_[depth].grid.side > kCoarsestSide; ++depth) {
      go_down(depth, build);
      if (first && build && depth >= kBulkyDepth && !speaks_for_most(depth + 1)) used_ = depth + 1;
      if (depth + 1 >= used_) break;
    }
    relax(depth, levels_[depth].grid.side > kCoarsestSide ? further_sweeps(depth) : kCoarsestSweeps);
    return depth;
  }

  /// Each level above, up to `top`, is corrected and relaxed.
  void climb(std::int32_t depth, std::int32_t top) noexcept {
    while (depth > top) {
      --depth;
      const Level &fine = levels_[depth], &coarse = levels_[depth + 1];
      const std::int32_t* ties = blocks_[depth + 1].ties;
      if (depth == 0) {
        for_each_cell(fine, ProlongToCell<true>{fine, coarse, ties});
      } else {
        for_each_cell(fine, ProlongToCell<false>{fine, coarse, ties});
      }
      relax(depth, 2 + further_sweeps(depth));
    }
  }

  void relax(std::int32_t depth, std::int32_t sweeps) noexcept {
    const std::int32_t side = levels_[depth].grid.side;
    for (std::int32_t colour = 0; colour < 2 * sweeps; ++colour)
      executor_.for_each_cell(side / 2, side, RelaxColour{levels_[depth], colour & 1});
  }

  /// Builds the blocks (unless they are there), relaxes twice, and hands on what is lacking.
  void go_down(std::int32_t depth, bool build) noexcept {
    const Level &fine = levels_[depth], &coarse = levels_[depth + 1];
    const BlockArrays& blocks = blocks_[depth + 1];
    if (build && depth == 0) for_each_cell(coarse, CoarsenBlock<true>{fine, coarse, blocks});
    if (build && depth > 0) for_each_cell(coarse, CoarsenBlock<false>{fine, coarse, blocks});
    relax(depth, 2);
    for_each_cell(coarse, RestrictToBlock{fine, coarse, blocks});
  }

  /// True where this level's blocks speak for enough of those below. Large ones in narrow passages do not: they lie
  /// across walls, and what they find for one passage is wrong in the next. The level and all above it are then left
  /// out.
  bool speaks_for_most(std::int32_t depth) noexcept {
    const std::int32_t side = levels_[depth].grid.side;
    executor_.for_each_cell(side, 1, SpokenOfRow{side, levels_[depth - 1].diagonal, blocks_[depth].ties, counted_});
    const Counted spoken = executor_.total(side, counted_);
    return static_cast<float>(spoken.cells) >= kSpokenShare * static_cast<float>(spoken.joined);
  }

  /// True where the last cycle has found hardly anything new.
  bool is_settled() noexcept {
    const Level& cells = levels_[0];
    executor_.for_each_cell(cells.grid.side, 1, TiltedOfRow{cells.grid, kTilt, cells.x, counted_});
    const Counted tilted = executor_.total(cells.grid.side, counted_);
    return kSettledShare * tilted.cells <= tilted.joined;
  }

  Executor& executor_;
  Level levels_[kMostLevels]{};  ///< finest first
  BlockArrays blocks_[kMostLevels]{};
  Counted* counted_ = nullptr;
  std::int32_t used_ = 0;  ///< levels that are of use on this map
};

}  // namespace jaywalk::paper
