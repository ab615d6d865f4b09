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
