#pragma once
// Coarse levels of the potential's solver: blocks of 2 x 2 cells, weighted by exp(-2 psi), the weights
// that make the rebased equations symmetric (docs/algorithm.md).
#include "planner/cell/potential.h"
#include "planner/field/grid.h"

namespace jaywalk::field {

/// One level; `grid` is its own. `diagonal` is what a cell's equation was divided by, `weight` its
/// share of its block's equation on the next level.
struct Level {
  Grid grid;
  const float* psi;
  const float* diagonal;
  const cell::Couplings* couplings;
  float* weight;
};

/// Builds a block's equation from its four cells.
struct CoarsenBlock {
  Level fine;
  Grid grid;
  float* psi;
  float* diagonal;
  cell::Couplings* couplings;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t block = grid.at(i, j);
    const float base = lowest_psi(i, j);
    cell::Couplings faces{0.0F, 0.0F, 0.0F, 0.0F};
    float killing = 0.0F;
    for (std::int32_t k = 0; k < 4; ++k) {
      const std::int32_t c = child(i, j, k);
      const cell::Couplings& a = fine.couplings[c];
      const float w = cell::sum(a) > 0.0F ? fine.diagonal[c] * cell::exp(-2.0F * (fine.psi[c] - base)) : 0.0F;
      fine.weight[c] = w;
      killing += w * (1.0F - cell::sum(a));
      // Twice the cells' distance lies between blocks: half the conductance.
      if ((k & 1) != 0)
        faces.east += 0.5F * w * a.east;
      else
        faces.west += 0.5F * w * a.west;
      if ((k & 2) != 0)
        faces.north += 0.5F * w * a.north;
      else
        faces.south += 0.5F * w * a.south;
    }
    const float conductance = cell::sum(faces);
    const float least = -0.2F * conductance;  // psi not yet harmonic: keeps the equation positive
    const float total = conductance + (killing > least ? killing : least);
    const float scale = conductance > 0.0F ? 1.0F / total : 0.0F;
    for (std::int32_t k = 0; k < 4; ++k) fine.weight[child(i, j, k)] *= scale;
    couplings[block] = {faces.east * scale, faces.west * scale, faces.north * scale, faces.south * scale};
    diagonal[block] = total;
    psi[block] = base;
  }

 private:
  JAYWALK_CELL std::int32_t child(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return fine.grid.at(2 * i + (k & 1), 2 * j + (k >> 1));
  }

  /// Of the cells that have an equation; any other value where none has.
  JAYWALK_CELL float lowest_psi(std::int32_t i, std::int32_t j) const {
    float lowest = cell::kUnreachable;
    for (std::int32_t k = 0; k < 4; ++k) {
      const std::int32_t c = child(i, j, k);
      if (cell::sum(fine.couplings[c]) > 0.0F && fine.psi[c] < lowest) lowest = fine.psi[c];
    }
    return lowest;
  }
};

/// A block's right-hand side, the weighted sum of what its cells lack; its correction starts from 0.
/// `fine_x` is ringed.
struct RestrictToBlock {
  Level fine;
  const float* fine_source;
  const float* fine_x;
  Grid grid;
  float* source;
  float* x;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    float lacking = 0.0F;
    for (std::int32_t k = 0; k < 4; ++k) {
      const std::int32_t c = fine.grid.at(2 * i + (k & 1), 2 * j + (k >> 1));
      const cell::Couplings& a = fine.couplings[c];
      const float to = cell::relaxed(a, fine_x[c + 1], fine_x[c - 1], fine_x[c + fine.grid.side],
                                     fine_x[c - fine.grid.side], fine_source[c]);
      lacking += fine.weight[c] * (to - fine_x[c]);
    }
    source[grid.at(i, j)] = lacking;
    x[grid.at(i, j)] = 0.0F;
  }
};

/// Adds the blocks' correction to a cell, bilinear (9, 3, 3, 1)/16 among the blocks that are coupled to its own.
struct ProlongToCell {
  Grid grid;  ///< the blocks'
  const cell::Couplings* couplings;
  const float* x;  ///< the blocks' corrections, ringed
  Grid fine_grid;
  bool finest;
  float* fine_x;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = fine_grid.at(i, j);
    const std::int32_t block = grid.at(i / 2, j / 2);
    const cell::Couplings& a = couplings[block];
    const std::int32_t di = (i & 1) != 0 ? 1 : -1, dj = (j & 1) != 0 ? grid.side : -grid.side;
    const bool beside = (di > 0 ? a.east : a.west) > 0.0F;
    const bool above = (dj > 0 ? a.north : a.south) > 0.0F;
    float value = 9.0F * x[block], weight = 9.0F;
    if (beside) value += 3.0F * x[block + di], weight += 3.0F;
    if (above) value += 3.0F * x[block + dj], weight += 3.0F;
    if (beside && above && cell::sum(couplings[block + di + dj]) > 0.0F) {
      value += x[block + di + dj], weight += 1.0F;
    }
    const float correction = value / weight;
    fine_x[c] = finest ? (fine_x[c] > 0.0F ? cell::corrected(fine_x[c], correction) : 0.0F) : fine_x[c] + correction;
  }
};

}  // namespace jaywalk::field
