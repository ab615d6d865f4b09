#pragma once
// Solves the rebased potential by V-cycles over blocks of 2 x 2. Order only; no formula lives here.
#include <cstddef>

#include "planner/field/coarse_stages.h"
#include "planner/field/executor.h"
#include "planner/field/potential_stages.h"

namespace jaywalk::field {

inline constexpr std::int32_t kCoarsestSide = 4;
inline constexpr std::int32_t kMostLevels = 11;  ///< 4 to 4096 cells a side

/// Cells a side beyond which a board's cells come from memory in every pass, and not from a cache of 32 MB: 512 x 512
/// cells are solved in 17 MB, four times as many in 70 (docs/explanation/results.md#time).
inline constexpr std::int32_t kLargeSide = 512;

struct Cycles {
  std::int32_t least, most;  ///< on from the least, until one has found hardly anything new
};

/// A level's memory. `diagonal` and the last two only blocks have a use for.
struct LevelArrays {
  CouplingArrays couplings;
  float *psi, *diagonal, *source, *x;
  BlockRows rows;
  float* correction;  ///< by rows
};

struct MultigridArrays {
  LevelArrays levels[kMostLevels];  ///< finest first
  Counted* counted;                 ///< by pieces of the finest board's rows
  std::int32_t* used;               ///< levels that are of use on this map, where one block takes the lower ones
};

template <class Executor>
[[nodiscard]] LevelArrays take_level(Executor& executor, std::int32_t side, bool finest) {
  const auto board = [&] { return executor.template take<float>(static_cast<std::size_t>(Board{side}.size())); };
  const auto rows = [&] { return take_rows<float>(executor, side); };
  LevelArrays a{{board(), board(), board(), board()}, board(), nullptr, board(), board(), {}, nullptr};
  if (finest) return a;
  a.diagonal = board();
  a.rows = {{rows(), rows(), rows(), rows()},       rows(), rows(), rows(), rows(), rows(),
            take_rows<std::int32_t>(executor, side)};
  a.correction = rows();
  return a;
}

/// Memory for grids up to `max_side` cells, a power of two from kCoarsestSide on.
template <class Executor>
[[nodiscard]] MultigridArrays take_multigrid(Executor& executor, std::int32_t max_side) {
  MultigridArrays a{};
  std::int32_t depth = 0;
  for (std::int32_t side = max_side; side >= kCoarsestSide; side /= 2, ++depth) {
    a.levels[depth] = take_level(executor, side, depth == 0);
  }
  a.counted = executor.template take<Counted>(pieces_of_grid<Executor>(max_side));
  a.used = executor.template take<std::int32_t>(1);
  return a;
}

/// How many sweeps, which levels and when it is enough.
struct CycleRules {
  static constexpr std::int32_t kCoarsestSweeps = 8;  ///< settles 4 x 4 blocks
  /// Further sweeps after a correction, by depth; even numbers. Blocks of 8 cells are the largest that still tell the
  /// two sides of an ordinary wall apart; a level's error leaves a long corridor along them, a block or two a sweep,
  /// and they are few. Blocks of 2 and 4 tell those of a thin one apart. Numbers by trial on random maps
  /// (docs/explanation/results.md#time).
  static constexpr JAYWALK_ORDER std::int32_t further_sweeps(std::int32_t depth) {
    return depth == 1 ? 6 : (depth == 2 ? 24 : (depth == kBulkyDepth ? 64 : 0));
  }
  static constexpr std::int32_t kBulkyDepth = 3;  ///< whose blocks are 8 cells wide
  /// Of the blocks below that have an equation, those that a level above these speaks for, at least, where it is used.
  /// (Open ground, rooms, boxes: 0.85 to 1. Corridors of 1.5 m: 0.78, with 0.5 on the next level.)
  static constexpr float kSpokenShare = 0.8F;
  /// A cycle that has tilted less than a 128th of the cells by more than a hundredth has found their directions: the
  /// next would tilt a tenth of that, and 99.9 % of cells and more pick the exact field's best neighbour
  /// (potential_test).
  static constexpr float kTilt = 0.01F;
  static constexpr std::int32_t kSettledShare = 128;

  /// Whether a level's blocks speak for enough of those below. Large ones in narrow passages do not: they lie across
  /// walls, and what they find for one passage is wrong in the next. The level and all above it are then left out.
  static constexpr JAYWALK_ORDER bool is_spoken_for(Counted spoken) {
    return static_cast<float>(spoken.cells) >= kSpokenShare * static_cast<float>(spoken.joined);
  }
  /// Whether a cycle has found hardly anything new.
  static constexpr JAYWALK_ORDER bool is_settled(Counted tilted) {
    return kSettledShare * tilted.cells <= tilted.joined;
  }
};

/// The lower levels of a cycle, for a block of threads that takes them alone: what is to be done on them is too little
/// for more, and its threads meet at once. (multigrid.h's order, on memory that stays near the block.)
struct LowerLevels {
  MultigridArrays arrays;
  std::int32_t side, depth;  ///< of the uppermost
  bool first, build;

  template <class Executor>
  JAYWALK_ORDER void operator()(Executor& executor) const noexcept;
};

/// The order of a solution's stages, for as long as one improvement takes.
template <class Executor>
class Multigrid {
 public:
  JAYWALK_ORDER Multigrid(Executor& executor, const MultigridArrays& arrays) : executor_(executor), arrays_(arrays) {}

  /// Improves the estimate that the step `first` leaves in psi (by rows; cell::kUnreachable and cell::kNotFree where
  /// that is so) by `least` cycles or more, until one has found hardly anything new, at most `most`; the steps `last`
  /// then visit the result. Returns how many. Blocks are weighted afresh each time: with the weights of the cycle
  /// before, the second makes things worse.
  template <class First, class... Last>
  std::int32_t improve(Grid grid, std::int32_t goal, float* psi, Cycles wanted, const First& first,
                       const Last&... last) noexcept {
    const Board board{grid.side};
    const LevelArrays& a = arrays_.levels[0];
    goal_row_ = goal / board.side;
    set_up(board, goal, psi, first);
    std::int32_t cycles = 0;
    for (bool enough = wanted.least == 0; !enough;) {
      cycle(board, cycles == 0);
      enough = ++cycles >= wanted.least && (cycles >= wanted.most || is_settled(board));
    }
    executor_.for_each_row(board.side, RowStep{board.half(), RebasePsi{board, 0, a.x, a.psi}},
                           RowStep{board.half(), RebasePsi{board, 1, a.x, a.psi}},
                           RowStep{board.half(), FromBoard{board, a.psi, psi}}, last...);
    return cycles;
  }

  /// From the uppermost of the lower levels down to the lowest of use, and back.
  JAYWALK_ORDER void go_through(const LowerLevels& lower) noexcept {
    used_ = lower.first && lower.build ? kMostLevels : *arrays_.used;
    Board board{lower.side};
    std::int32_t depth = lower.depth;
    (void)descend(board, depth, lower.first, false, lower.build);
    climb(board, depth, lower.depth);
    executor_.for_each(1, Fill<std::int32_t>{arrays_.used, used_});
  }

 private:
  using Rules = CycleRules;

  template <class First>
  void set_up(Board board, std::int32_t goal, const float* psi, const First& first) noexcept {
    const LevelArrays& a = arrays_.levels[0];
    const Sources sources = sources_of(0, board);
    const std::int32_t half = board.half();
    executor_.for_each_row(board.side, first, RowStep{half, ToBoard{board, psi, a.psi}},
                           RowStep{half, CoupleAhead{board, 0, a.psi, a.couplings, sources, a.x}},
                           RowStep{half, CoupleAhead{board, 1, a.psi, a.couplings, sources, a.x}},
                           RowStep{half, CoupleBack{board, 0, a.psi, a.couplings}},
                           RowStep{half, CoupleBack{board, 1, a.psi, a.couplings}});
    executor_.for_each(1, SettleGoal{board, goal, a.couplings, a.source});
  }

  /// Down and back. The first cycle finds out which levels are of use; the others carry over what the one before has
  /// found. On a large board blocks of 2 cells go down and back once more before the cells do, where blocks larger than
  /// 8 cells are of use: what is lacking there is smooth, and blocks are at hand where cells come from memory.
  void cycle(Board board, bool first) noexcept {
    const bool is_large = board.side > kLargeSide;
    if (first) used_ = kMostLevels;
    std::int32_t depth = 0;
    const std::int32_t lowest = descend(board, depth, first, !first, true);
    if (is_large && lowest > Rules::kBulkyDepth) {
      climb(board, depth, 1);
      (void)descend(board, depth, first, false, false);
    }
    climb(board, depth, 0);
  }

  /// Down to the lowest level of use, which is relaxed, or to where one block has taken the rest. `build`: the levels'
  /// equations, unless they are there. Returns the lowest level, or the first of that rest.
  JAYWALK_ORDER std::int32_t descend(Board& board, std::int32_t& depth, bool first, bool rebase, bool build) noexcept {
    for (; board.side > kCoarsestSide; ++depth, board.side /= 2) {
      if (depth > 0 && board.side <= Executor::kOneBlockSide) {
        executor_.in_one_block(LowerLevels{arrays_, board.side, depth, first, build});
        return depth;
      }
      const Board blocks{board.side / 2};
      go_down(board, depth, rebase, build);
      if (first && build && depth >= Rules::kBulkyDepth && !speaks_for_most(blocks, depth + 1)) used_ = depth + 1;
      if (depth + 1 >= used_) break;
    }
    relax(board, depth, board.side > kCoarsestSide ? Rules::further_sweeps(depth) : Rules::kCoarsestSweeps);
    return depth;
  }

  /// Each level above, up to `top`, is corrected and relaxed.
  JAYWALK_ORDER void climb(Board& board, std::int32_t& depth, std::int32_t top) noexcept {
    while (depth > top) {
      --depth, board.side *= 2;
      relax(board, depth, go_up(board, depth) + Rules::further_sweeps(depth));
    }
  }

  /// Of cells, none but the goal and those beside it have a source.
  [[nodiscard]] JAYWALK_ORDER Sources sources_of(std::int32_t depth, Board board) const {
    if (Executor::kInTurn && depth == 0) return {arrays_.levels[0].source, goal_row_ - 1, goal_row_ + 1};
    return {arrays_.levels[depth].source, 0, board.side - 1};
  }

  [[nodiscard]] JAYWALK_ORDER RowStep<RelaxColour> relaxed(Board board, std::int32_t depth, std::int32_t colour) const {
    const LevelArrays& a = arrays_.levels[depth];
    return {board.half(), {board, colour, a.couplings, sources_of(depth, board), a.x}};
  }

  /// Two sweeps a round: what the first has fetched is at hand for the second.
  JAYWALK_ORDER void relax(Board board, std::int32_t depth, std::int32_t sweeps) noexcept {
    if constexpr (Executor::kLowerLevels) {
      executor_.repeat(sweeps, board.side, relaxed(board, depth, 0), relaxed(board, depth, 1));
    } else {
      executor_.repeat(sweeps / 2, board.side, relaxed(board, depth, 0), relaxed(board, depth, 1),
                       relaxed(board, depth, 0), relaxed(board, depth, 1));
    }
  }

  JAYWALK_ORDER void go_down(Board board, std::int32_t depth, bool rebase, bool build) noexcept {
    if constexpr (!Executor::kLowerLevels) {
      const LevelArrays& a = arrays_.levels[0];
      const Sources sources = sources_of(0, board);
      const std::int32_t half = rebase ? board.half() : 0;
      if (depth == 0)
        return hand_on<true>(board, depth, build, RowStep{half, RebaseCouplings{board, 0, a.x, a.couplings, sources}},
                             RowStep{half, RebaseCouplings{board, 1, a.x, a.couplings, sources}},
                             RowStep{half, RebasePsi{board, 0, a.x, a.psi}},
                             RowStep{half, RebasePsi{board, 1, a.x, a.psi}});
    }
    hand_on<false>(board, depth, build);
  }

  /// After the steps `before` builds the blocks (unless they are there), relaxes twice, and hands on what is lacking.
  template <bool kFinest, class... Before>
  JAYWALK_ORDER void hand_on(Board board, std::int32_t depth, bool build, const Before&... before) noexcept {
    const LevelArrays& a = arrays_.levels[depth];
    const LevelArrays& b = arrays_.levels[depth + 1];
    const Board blocks{board.side / 2};
    const Sources sources = sources_of(depth, board);
    const Level level{board, a.couplings, a.psi, a.diagonal};
    const std::int32_t built = build ? blocks.half() : 0;
    executor_.for_each_row(
        board.side, before..., RowStep{2 * built, CoarsenBlock<kFinest>{level, blocks.side, b.rows}, 2},
        RowStep{built, BlocksToBoard{blocks, b.rows, b.couplings, b.psi, b.diagonal}, 2}, relaxed(board, depth, 0),
        relaxed(board, depth, 1), relaxed(board, depth, 0), relaxed(board, depth, 1),
        RowStep{blocks.side, RestrictToBlock{level, sources, a.x, blocks.side, b.rows}, 2},
        RowStep{blocks.half(), LackingToBoard{blocks, b.rows.lacking, b.source, b.x}, 2});
  }

  /// Adds what the blocks have found, and begins to relax. Returns how many of two sweeps are left.
  JAYWALK_ORDER std::int32_t go_up(Board board, std::int32_t depth) noexcept {
    if constexpr (!Executor::kLowerLevels) {
      if (depth == 0) return take_back<true>(board, depth);
    }
    return take_back<false>(board, depth);
  }

  template <bool kFinest>
  JAYWALK_ORDER std::int32_t take_back(Board board, std::int32_t depth) noexcept {
    const LevelArrays& a = arrays_.levels[depth];
    const LevelArrays& b = arrays_.levels[depth + 1];
    const Board blocks{board.side / 2};
    const auto prolong = [&](std::int32_t colour) {
      return RowStep<ProlongToCell<kFinest>>{board.half(),
                                             {blocks.side, b.rows.ties, b.correction, board, colour, a.x}};
    };
    executor_.for_each_cell(blocks.half(), blocks.side, FromBoard{blocks, b.x, b.correction});
    if constexpr (Executor::kLowerLevels) {
      executor_.for_each_row(board.side, prolong(0), prolong(1));
      return 2;
    } else {
      executor_.for_each_row(board.side, prolong(0), prolong(1), relaxed(board, depth, 0), relaxed(board, depth, 1),
                             relaxed(board, depth, 0), relaxed(board, depth, 1));
      return 0;
    }
  }

  /// Whether this level's blocks speak for enough of those below.
  JAYWALK_ORDER bool speaks_for_most(Board board, std::int32_t depth) noexcept {
    executor_.for_each_cell(1, board.side,
                            SpokenOfRow{board.side, arrays_.levels[depth - 1].rows.diagonal,
                                        arrays_.levels[depth].rows.ties, arrays_.counted});
    return Rules::is_spoken_for(executor_.total(board.side, arrays_.counted));
  }

  /// Whether the last cycle has found hardly anything new.
  JAYWALK_ORDER bool is_settled(Board board) noexcept {
    const std::int32_t cells = cells_of_row<Executor>(board.side), pieces = board.side / cells;
    executor_.for_each_cell(pieces, board.side,
                            TiltedOfRow{board, cells, Rules::kTilt, arrays_.levels[0].x, arrays_.counted});
    return Rules::is_settled(executor_.total(pieces * board.side, arrays_.counted));
  }

  Executor& executor_;
  const MultigridArrays& arrays_;
  std::int32_t goal_row_ = 0;
  std::int32_t used_ = 0;  ///< levels that are of use on this map
};

template <class Executor>
JAYWALK_ORDER void LowerLevels::operator()(Executor& executor) const noexcept {
  Multigrid<Executor>(executor, arrays).go_through(*this);
}

}  // namespace jaywalk::field
