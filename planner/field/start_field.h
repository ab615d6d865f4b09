#pragma once
// The start field: shortest ways to the goal in integer costs, so that the result is unique whatever
// the order. A step costs what -ln u would rise by in a passage as wide as the one it is in; the sum
// is an estimate of psi, descends to the goal from everywhere, and keeps away from walls.
#include <vector>

#include "planner/cell/clearance.h"
#include "planner/cell/step.h"
#include "planner/field/executor.h"
#include "planner/field/grid.h"

namespace jaywalk::field {

/// Cost units per unit of psi.
inline constexpr float kCostsPerPsi = 4096.0F;
inline constexpr std::uint32_t kNoWay = 0xffffffffU;
/// A step costs less than this: the dearest is a diagonal one of w = 2 x 2697, in a passage one cell wide, 8,518.
inline constexpr std::uint32_t kDearestStep = 16384;
/// Nothing is sought beyond this cost, a million units of psi: 800,000 cells of a passage one cell wide. What lies
/// there counts as out of reach.
inline constexpr std::uint32_t kFarthest = kNoWay - kDearestStep;

/// Half a step's cost by passage width in steps of a quarter cell: half of acosh(2 - cos(pi/(w+1))),
/// the rate at which a harmonic function decays along a passage w cells wide.
[[nodiscard]] std::vector<std::uint16_t> rate_table(std::int32_t max_side);

/// Half of a step's cost in each cell, from its passage's width; 0: not free.
struct RateOfEachCell {
  Grid grid;
  const float* clearance;
  const std::uint16_t* table;
  std::uint16_t* rate;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    if (clearance[c] <= 0.0F) {
      rate[c] = 0;
      return;
    }
    const float east = i < grid.side - 1 ? clearance[c + 1] : 0.0F, west = i > 0 ? clearance[c - 1] : 0.0F;
    const float north = j < grid.side - 1 ? clearance[c + grid.side] : 0.0F,
                south = j > 0 ? clearance[c - grid.side] : 0.0F;
    const float width = cell::passage_width(clearance[c], east > west ? east : west, north > south ? north : south);
    rate[c] = table[static_cast<std::int32_t>(4.0F * width)];
  }
};

/// Everything far but the goal.
struct FarFromGoal {
  std::int32_t goal;
  std::uint32_t* cost;

  JAYWALK_CELL void operator()(std::int32_t c) const { cost[c] = c == goal ? 0U : kNoWay; }
};

/// Relaxes one line of cells forth and back. Rows, columns and diagonals (StepAcross) in turn, until nothing changes,
/// reach the unique fixed point cost[n] = min(cost[c] + step). A line is one thread's alone.
struct SweepLine {
  std::int32_t length;
  std::int32_t along;   ///< index step from a cell to the next on its line, 1 or more
  std::int32_t across;  ///< index step from a line to the next
  const std::uint16_t* rate;
  std::uint32_t* cost;
  Counted* changed;  ///< a line: whether it did

  JAYWALK_CELL void operator()(std::int32_t line) const {
    const std::int32_t first = line * across;
    const std::int32_t last = first + (length - 1) * along;
    std::int32_t any = 0;
    for (std::int32_t c = first; c < last; c += along) any |= relax(c, c + along);
    for (std::int32_t c = last; c > first; c -= along) any |= relax(c, c - along);
    changed[line].cells |= any;
  }

 private:
  JAYWALK_CELL std::int32_t relax(std::int32_t from, std::int32_t to) const {
    if (rate[from] == 0 || rate[to] == 0 || cost[from] >= kFarthest) return 0;
    const std::uint32_t through = cost[from] + cell::straight_step(rate[from], rate[to]);
    if (through >= cost[to]) return 0;
    cost[to] = through;
    return 1;
  }
};

/// Diagonal steps into every other row, the even or the odd ones, from the rows on either side; a piece of a row at a
/// time.
struct StepAcross {
  Grid grid;
  std::int32_t odd;
  std::int32_t cells;  ///< of a piece; divides the side
  const std::uint16_t* rate;
  std::uint32_t* cost;
  Counted* changed;  ///< a piece, row by row: whether it did

  JAYWALK_CELL void operator()(std::int32_t piece, std::int32_t pair) const {
    const std::int32_t j = 2 * pair + odd;
    std::int32_t any = 0;
    for (std::int32_t i = piece * cells, end = i + cells; i < end; ++i) any |= step_into(i, j);
    changed[j * (grid.side / cells) + piece].cells |= any;
  }

 private:
  JAYWALK_CELL std::int32_t step_into(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    if (rate[c] == 0) return 0;
    std::uint32_t best = cost[c];
    for (std::int32_t dj = -1; dj <= 1; dj += 2) {
      for (std::int32_t di = -1; di <= 1; di += 2) {
        if (grid.holds(i + di, j + dj))
          best = lower(best, through(grid.at(i + di, j + dj), c + di, grid.at(i, j + dj), c));
      }
    }
    if (best == cost[c]) return 0;
    cost[c] = best;
    return 1;
  }
  JAYWALK_CELL static std::uint32_t lower(std::uint32_t a, std::uint32_t b) { return a < b ? a : b; }
  JAYWALK_CELL std::uint32_t through(std::int32_t from, std::int32_t a, std::int32_t b, std::int32_t to) const {
    if (rate[from] == 0 || rate[a] == 0 || rate[b] == 0 || cost[from] >= kFarthest) return kNoWay;
    return cost[from] + cell::diagonal_step(rate[from], rate[to], rate[a], rate[b]);
  }
};

/// psi as the costs have it.
struct PsiOfCost {
  const std::uint16_t* rate;
  const std::uint32_t* cost;
  float* psi;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    psi[c] = rate[c] == 0        ? cell::kNotFree
             : cost[c] == kNoWay ? cell::kUnreachable
                                 : static_cast<float>(cost[c]) * (1.0F / kCostsPerPsi);
  }
};

}  // namespace jaywalk::field
