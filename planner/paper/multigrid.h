#pragma once
// Solves the rebased potential by V-cycles over blocks of 2 x 2. Order only; no formula lives here.
#include "planner/paper/potential_stages.h"

namespace jaywalk::paper {

/// Bits of a level's `ties`: coupled to the next block east, north.
inline constexpr std::int32_t kOpenEast = 16, kOpenNorth = 32;

/// Builds the equations of blocks from their four cells each.
template <bool kFinest>
struct CoarsenBlock {
  Level fine, coarse;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t block = coarse.grid.at(i, j);
    const std::int32_t c00 = fine.grid.at(2 * i, 2 * j), c10 = c00 + 1, c01 = c00 + fine.grid.side, c11 = c01 + 1;
    const Couplings a00 = fine.couplings.at(c00), a10 = fine.couplings.at(c10);
    const Couplings a01 = fine.couplings.at(c01), a11 = fine.couplings.at(c11);
    const float base = lower(lower(psi_of(c00, a00), psi_of(c10, a10)), lower(psi_of(c01, a01), psi_of(c11, a11)));
    // It speaks for its lowest cell and those joined to that one inside it, not for what lies behind a wall.
    const bool south = a00.east > 0.0F, north = a01.east > 0.0F, west = a00.north > 0.0F, east = a10.north > 0.0F;
    bool m00 = psi_of(c00, a00) == base, m10 = psi_of(c10, a10) == base;
    bool m01 = psi_of(c01, a01) == base, m11 = psi_of(c11, a11) == base;
    for (int step = 0; step < 2; ++step) {  // the farthest cell is two steps away
      const bool n00 = m00 | (south & m10) | (west & m01), n10 = m10 | (south & m00) | (east & m11);
      const bool n01 = m01 | (north & m11) | (west & m00), n11 = m11 | (north & m01) | (east & m10);
      m00 = n00, m10 = n10, m01 = n01, m11 = n11;
    }
    const float w00 = weight(c00, a00, base, m00), w10 = weight(c10, a10, base, m10);
    const float w01 = weight(c01, a01, base, m01), w11 = weight(c11, a11, base, m11);
    // Blocks lie twice as far apart as cells: half the conductance.
    const Couplings faces{0.5F * (w10 * a10.east + w11 * a11.east), 0.5F * (w00 * a00.west + w01 * a01.west),
                          0.5F * (w01 * a01.north + w11 * a11.north), 0.5F * (w00 * a00.south + w10 * a10.south)};
    const float killing =
        (w00 * (1.0F - sum(a00)) + w10 * (1.0F - sum(a10))) + (w01 * (1.0F - sum(a01)) + w11 * (1.0F - sum(a11)));
    const float conductance = sum(faces);
    const float least = -0.2F * conductance;  // while psi is not yet harmonic: keeps the equation positive
    const float total = conductance + (killing > least ? killing : least);
    const float scale = conductance > 0.0F ? 1.0F / total : 0.0F;
    const Couplings a{faces.east * scale, faces.west * scale, faces.north * scale, faces.south * scale};
    coarse.couplings.set(block, a);
    coarse.psi[block] = base;
    coarse.diagonal[block] = total;
    coarse.low_weight[block] = w00 * scale;
    coarse.high_weight[block] = w11 * scale;
    coarse.ties[block] = (m00 ? 1 : 0) | (m10 ? 2 : 0) | (m01 ? 4 : 0) | (m11 ? 8 : 0) |
                         (a.east > 0.0F ? kOpenEast : 0) | (a.north > 0.0F ? kOpenNorth : 0);
  }

 private:
  JAYWALK_CELL static float lower(float a, float b) { return a < b ? a : b; }
  /// psi of a cell that has an equation; above all others where it has none.
  JAYWALK_CELL float psi_of(std::int32_t c, const Couplings& a) const {
    return sum(a) > 0.0F ? fine.psi[c] : cell::kLargest;
  }
  JAYWALK_CELL float weight(std::int32_t c, const Couplings& a, float base, bool is_member) const {
    const bool has_equation = (sum(a) > 0.0F) & is_member;
    if constexpr (kFinest) {
      return block_weight(has_equation, 1.0F, fine.psi[c], base);
    } else {
      return block_weight(has_equation, fine.diagonal[c], fine.psi[c], base);
    }
  }
};

/// Count of the blocks below with an equation for which a row of blocks speaks.
struct SpokenOfRow {
  std::int32_t side;         ///< blocks a row
  const float* diagonal;     ///< of those below
  const std::int32_t* ties;  ///< of these
  Counted* spoken;           ///< joined: those below with an equation

  JAYWALK_CELL void operator()(std::int32_t j) const {
    std::int32_t speaks = 0, joins = 0;
    for (std::int32_t i = 0; i < 2 * side; ++i) {
      for (std::int32_t north = 0; north < 2; ++north) {
        const bool has_equation = diagonal[(2 * j + north) * 2 * side + i] > 0.0F;
        const bool is_member = (ties[j * side + i / 2] & (1 << (i % 2 + 2 * north))) != 0;
        joins += has_equation ? 1 : 0;
        speaks += (has_equation & is_member) ? 1 : 0;
      }
    }
    spoken[j] = {speaks, joins};
  }
};

/// The right-hand sides of blocks: the weighted sum of what their cells lack. Odd cells lack nothing, they were relaxed
/// last. The blocks' corrections start from 0.
struct RestrictToBlock {
  Level fine, coarse;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t block = coarse.grid.at(i, j), low = fine.grid.at(2 * i, 2 * j), high = low + fine.grid.side + 1;
    coarse.source[block] = coarse.low_weight[block] * lacking(low) + coarse.high_weight[block] * lacking(high);
    coarse.x[block] = 0.0F;
  }

 private:
  JAYWALK_CELL float lacking(std::int32_t c) const { return fine.relaxed(c) - fine.x[c]; }
};

/// Adds the blocks' corrections to the cells, bilinear (9, 3, 3, 1)/16 among the blocks that are coupled to the cell's
/// own, where that one speaks for the cell.
template <bool kFinest>
struct ProlongToCell {
  Level fine, coarse;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = fine.grid.at(i, j), side = coarse.grid.side, block = coarse.grid.at(i / 2, j / 2);
    const std::int32_t east = i & 1, north = j & 1;  // 1: the block's eastern, northern half
    const std::int32_t beside = block + 2 * east - 1, step = (2 * north - 1) * side;
    const std::int32_t face = (north - 1) * side;  // of a block, to its own northern face or the one below
    const float* correction = coarse.x;
    const float to_beside = is_open(block + east - 1, kOpenEast), to_above = is_open(block + face, kOpenNorth);
    const float to_corner = to_beside * to_above * is_open(beside + face, kOpenNorth);
    const float value = 9.0F * correction[block] + 3.0F * (to_beside * correction[beside]) +
                        (3.0F * (to_above * correction[block + step]) + to_corner * correction[beside + step]);
    const float weight = 9.0F + 3.0F * (to_beside + to_above) + to_corner;
    const float mean = (coarse.ties[block] & (1 << (east + 2 * north))) != 0 ? value / weight : 0.0F;
    if constexpr (kFinest) {
      fine.x[c] = corrected(fine.x[c], mean);
    } else {
      fine.x[c] += mean;
    }
  }

 private:
  JAYWALK_CELL float is_open(std::int32_t block, std::int32_t tie) const {
    return (coarse.ties[block] & tie) != 0 ? 1.0F : 0.0F;
  }
};

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

  /// Improves psi by `wanted` cycles. Returns how many. Blocks are weighted afresh each time: with the weights of the
  /// cycle before, the second makes things worse.
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
  /// A cycle that has tilted less than a 128th of the cells by more than a hundredth has found their directions: 99.9 %
  /// of cells and more then pick the exact field's best neighbour (potential_test).
  static constexpr float kTilt = 0.01F;
  static constexpr std::int32_t kSettledShare = 128;

  /// Further sweeps after a correction, by depth. Blocks of 8 cells are the largest that still tell the two sides of an
  /// ordinary wall apart, blocks of 2 and 4 those of a thin one. Numbers by trial on random maps
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
    take(level.psi), take(level.diagonal), take(level.low_weight), take(level.high_weight);
    level.ties = take_rows<std::int32_t>(executor_, side);
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

  /// Goes down to the lowest level of use, relaxes it, and returns it. `build`: the levels' equations are not there.
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
      if (depth == 0) {
        for_each_cell(fine, ProlongToCell<true>{fine, coarse});
      } else {
        for_each_cell(fine, ProlongToCell<false>{fine, coarse});
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
    if (build && depth == 0) for_each_cell(coarse, CoarsenBlock<true>{fine, coarse});
    if (build && depth > 0) for_each_cell(coarse, CoarsenBlock<false>{fine, coarse});
    relax(depth, 2);
    for_each_cell(coarse, RestrictToBlock{fine, coarse});
  }

  /// True where this level's blocks speak for enough of those below. Large ones in narrow passages lie across walls;
  /// the level and all above it are then left out.
  bool speaks_for_most(std::int32_t depth) noexcept {
    const std::int32_t side = levels_[depth].grid.side;
    executor_.for_each_cell(side, 1, SpokenOfRow{side, levels_[depth - 1].diagonal, levels_[depth].ties, counted_});
    const Counted spoken = executor_.total(side, counted_);
    return static_cast<float>(spoken.cells) >= kSpokenShare * static_cast<float>(spoken.joined);
  }

  bool is_settled() noexcept {
    const Level& cells = levels_[0];
    executor_.for_each_cell(cells.grid.side, 1, TiltedOfRow{cells.grid, kTilt, cells.x, counted_});
    const Counted tilted = executor_.total(cells.grid.side, counted_);
    return kSettledShare * tilted.cells <= tilted.joined;
  }

  Executor& executor_;
  Level levels_[kMostLevels]{};  ///< finest first
  Counted* counted_ = nullptr;
  std::int32_t used_ = 0;  ///< levels that are of use on this map
};

}  // namespace jaywalk::paper
