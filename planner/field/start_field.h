#pragma once
// The start field: shortest ways to the goal in integer costs, so that the result is unique whatever
// the order. A step costs what -ln u would rise by in a passage as wide as the one it is in; the sum
// is an estimate of psi, descends to the goal from everywhere, and keeps away from walls.
#include <vector>

#include "planner/cell/clearance.h"
#include "planner/cell/step.h"
#include "planner/field/executor.h"
#include "planner/mapping/grid.h"

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

/// A direction of steps.
struct Along {
  std::int32_t di, dj;
};

/// Relaxes a piece of a line of cells forth and back, and takes in what the cells before and after it have. Rows,
/// columns and both diagonals in turn, of each the even and then the odd pieces, until nothing changes, reach the
/// unique fixed point cost[n] = min(cost[c] + step). A line goes by rows, at position p in column p; all others go by
/// columns, at position p in row p. A diagonal that leaves the grid at one side goes on at the other, without a step
/// between.
struct SweepPiece {
  Grid grid;
  Along along;
  std::int32_t odd;
  std::int32_t cells;  ///< of a piece; divides the side
  const std::uint16_t* rate;
  std::uint32_t* cost;
  Counted* changed;  ///< a piece, line by line: whether it did since the last sweep of rows, that included

  JAYWALK_CELL void operator()(std::int32_t line, std::int32_t pair) const {
    const std::int32_t piece = 2 * pair + odd, first = piece * cells, last = first + cells - 1;
    std::int32_t any = 0;
    for (std::int32_t p = first > 0 ? first - 1 : 0; p < last; ++p) any |= relax(line, p, 1);
    for (std::int32_t p = last + 1 < grid.side ? last + 1 : last; p > first; --p) any |= relax(line, p, -1);
    Counted& count = changed[line * (grid.side / cells) + piece];
    count.cells = along.dj == 0 ? any : count.cells | any;
  }

 private:
  /// The cell after position p of a line, or the one before it.
  JAYWALK_CELL std::int32_t relax(std::int32_t line, std::int32_t p, std::int32_t way) const {
    const std::int32_t i = along.dj == 0 ? p : (line + along.di * p) & (grid.side - 1);
    const std::int32_t j = along.dj == 0 ? line : p;
    const std::int32_t to_i = i + way * along.di, to_j = j + way * along.dj;
    if (!grid.holds(to_i, to_j)) return 0;
    const std::int32_t from = grid.at(i, j), to = grid.at(to_i, to_j);
    const std::int32_t a = grid.at(to_i, j), b = grid.at(i, to_j);  // of a straight step its own two cells
    if (rate[from] == 0 || rate[to] == 0 || rate[a] == 0 || rate[b] == 0 || cost[from] >= kFarthest) return 0;
    const bool straight = along.di == 0 || along.dj == 0;
    const std::uint32_t through = cost[from] + (straight ? cell::straight_step(rate[from], rate[to])
                                                         : cell::diagonal_step(rate[from], rate[to], rate[a], rate[b]));
    if (through >= cost[to]) return 0;
    cost[to] = through;
    return 1;
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
