#pragma once
// The start field: shortest ways to the goal in integer costs, so that the result is unique whatever
// the order. A step costs what -ln u would rise by in a passage as wide as the one it is in; the sum
// is an estimate of psi, descends to the goal from everywhere, and keeps away from walls.
#include <vector>

#include "planner/cell/clearance.h"
#include "planner/field/grid.h"

namespace jaywalk::field {

/// Cost units per unit of psi. A step costs at most 3942 (a passage two cells wide), so the longest way through
/// 1024 x 1024 cells stays below 2^32; one through a passage of 512 cells still costs 25.
inline constexpr float kCostsPerPsi = 4096.0F;
inline constexpr std::uint32_t kNoWay = 0xffffffffU;

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
    float best = 0.0F;
    if (i > 0 && clearance[c - 1] > best) best = clearance[c - 1];
    if (i < grid.side - 1 && clearance[c + 1] > best) best = clearance[c + 1];
    if (j > 0 && clearance[c - grid.side] > best) best = clearance[c - grid.side];
    if (j < grid.side - 1 && clearance[c + grid.side] > best) best = clearance[c + grid.side];
    rate[c] = table[static_cast<std::int32_t>(4.0F * cell::passage_width(clearance[c], best))];
  }
};

/// Everything far but the goal.
struct FarFromGoal {
  std::int32_t goal;
  std::uint32_t* cost;

  JAYWALK_CELL void operator()(std::int32_t c) const { cost[c] = c == goal ? 0U : kNoWay; }
};

/// Relaxes one line of cells forth and back. Rows and columns in turn, until nothing changes, reach the unique
/// fixed point cost[n] = min(cost[c] + rate[c] + rate[n]). A line is one thread's alone.
struct SweepLine {
  std::int32_t length;
  std::int32_t along;   ///< index step from a cell to the next on its line
  std::int32_t across;  ///< index step from a line to the next
  const std::uint16_t* rate;
  std::uint32_t* cost;
  std::uint32_t* changed;  ///< a line: whether it did

  JAYWALK_CELL void operator()(std::int32_t line) const {
    const std::int32_t first = line * across;
    const std::int32_t last = first + (length - 1) * along;
    std::uint32_t any = 0;
    for (std::int32_t c = first; c != last; c += along) any |= relax(c, c + along);
    for (std::int32_t c = last; c != first; c -= along) any |= relax(c, c - along);
    changed[line] |= any;
  }

 private:
  JAYWALK_CELL std::uint32_t relax(std::int32_t from, std::int32_t to) const {
    if (rate[from] == 0 || rate[to] == 0 || cost[from] == kNoWay) return 0;
    const std::uint32_t through = cost[from] + rate[from] + rate[to];
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

/// The same fixed point by a queue of buckets: what one thread does best. A cell is in one bucket at a
/// time, so memory is two links a cell; costs within a bucket may be taken in any order, since a cell
/// that improves is queued again. All that is known of a cell lies together, with a ring of cells
/// round the grid that are not free, so that a step is one fetch and no question.
class BucketQueue {
 public:
  explicit BucketQueue(std::int32_t max_side);
  /// Fills `cost`: 0 at the goal, a free cell; kNoWay where there is no way or the rate is 0.
  void settle(Grid grid, std::int32_t goal, const std::uint16_t* rate, std::uint32_t* cost) noexcept;

 private:
  static constexpr std::uint32_t kBucketShift = 7;  ///< 128 costs a bucket
  static constexpr std::uint32_t kBuckets = 64;     ///< in a ring: more than the dearest step covers

  struct Node {
    std::uint32_t cost, rate;
    std::int32_t next, previous;
  };

  [[nodiscard]] Node& node(std::int32_t n) noexcept { return nodes_[static_cast<std::size_t>(n)]; }
  void load(Grid grid, const std::uint16_t* rate) noexcept;
  void insert(std::int32_t n) noexcept;
  void remove(std::int32_t n) noexcept;
  void relax(const Node& from, std::int32_t to) noexcept;

  std::vector<Node> nodes_;
  std::int32_t heads_[kBuckets];
  std::int32_t queued_ = 0;
};

}  // namespace jaywalk::field
