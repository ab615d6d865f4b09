#pragma once
// Coarse levels of the potential's solver: blocks of 2 x 2 cells, weighted by exp(-2 psi), the weights
// that make the rebased equations symmetric (docs/explanation/algorithm.md).
#include "planner/paper/potential_stages.h"

namespace jaywalk::paper {
/// Arrays of blocks beside a level's equations.
struct BlockArrays {
  float *low_weight, *high_weight;  ///< of the block's (0, 0) and (1, 1) cells in its right-hand side
  /// Cells that a block speaks for: bits 0 to 3 for (0, 0), (1, 0), (0, 1), (1, 1); kOpenEast, kOpenNorth. May be
  /// read beyond the border (take_rows).
  std::int32_t* ties;
};

/// Bits of `ties`: coupled to the next block east, north.
inline constexpr std::int32_t kOpenEast = 16, kOpenNorth = 32;

/// Builds the equations of blocks from their four cells each.
template <bool kFinest>
struct CoarsenBlock {
  Level fine, coarse;
  BlockArrays blocks;

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
    blocks.low_weight[block] = w00 * scale;
    blocks.high_weight[block] = w11 * scale;
    blocks.ties[block] = (m00 ? 1 : 0) | (m10 ? 2 : 0) | (m01 ? 4 : 0) | (m11 ? 8 : 0) |
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
  BlockArrays blocks;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t block = coarse.grid.at(i, j), low = fine.grid.at(2 * i, 2 * j), high = low + fine.grid.side + 1;
    coarse.source[block] = blocks.low_weight[block] * lacking(low) + blocks.high_weight[block] * lacking(high);
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
  const std::int32_t* ties;

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
    const float mean = (ties[block] & (1 << (east + 2 * north))) != 0 ? value / weight : 0.0F;
    if constexpr (kFinest) {
      fine.x[c] = corrected(fine.x[c], mean);
    } else {
      fine.x[c] += mean;
    }
  }

 private:
  JAYWALK_CELL float is_open(std::int32_t block, std::int32_t tie) const {
    return (ties[block] & tie) != 0 ? 1.0F : 0.0F;
  }
};

}  // namespace jaywalk::paper
