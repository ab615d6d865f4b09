#pragma once
// The start field: shortest ways to the goal in integer costs. A step costs what -ln u would rise by in a passage as
// wide as the one it is in; the sum is an estimate of psi, descends to the goal from everywhere, and keeps away from
// walls.
#include <vector>

#include "planner/cost_to_go/shortest.h"
#include "planner/paper/executor.h"

namespace jaywalk::paper {

// Cost of a step of the start field, from half the costs (`rate`) of the cells that it touches. Integers, so that
// the dearest and the cheapest way are the same whatever the order.

/// Between two cells side by side.
JAYWALK_CELL std::uint32_t straight_step(std::uint32_t from, std::uint32_t to) { return from + to; }

/// Between two cells at a corner; `a` and `b` are the free ones beside both. Dearer than straight ahead by a quarter in
/// wide rooms and by more in narrow passages, where turning costs more: 5/4 w + w^2/16384, w a straight step of 4096 to
/// a unit of -ln u. Measured with exact_psi; so that estimates are rather too high than too low, since cycles correct
/// upwards by a factor of eight at most. Never so cheap that neither `a` nor `b` is lower than where the step leads,
/// from either end: descent by four neighbours arrives too.
JAYWALK_CELL std::uint32_t diagonal_step(std::uint32_t from, std::uint32_t to, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t straight = from + to, wanted = straight + straight / 4 + straight * straight / 16384;
  const std::uint32_t least = (a < b ? a : b) + (from > to ? from : to) + 1;
  return wanted > least ? wanted : least;
}

/// Cost units per unit of psi.
inline constexpr float kCostsPerPsi = 4096.0F;
/// Nothing is sought beyond this cost, a million units of psi: 800,000 cells of a passage one cell wide. What lies
/// there counts as out of reach. (The dearest step, a diagonal one of w = 2 x 2697, costs 8,518.)
inline constexpr std::uint32_t kFarthest = field::kNoWay - 16384;

/// Half a step's cost by passage width in steps of a quarter cell: half of acosh(2 - cos(pi/(w+1))),
/// the rate at which a harmonic function decays along a passage w cells wide.
[[nodiscard]] std::vector<std::uint16_t> rate_table(std::int32_t max_side);

/// Cells and the steps to eight neighbours, as field::Shortest wants them; a ring of cells about them is not free, so
/// that a step asks for no border. A diagonal step passes between two free cells.
class StartGraph {
 public:
  using Cost = std::uint32_t;
  static constexpr std::uint32_t kSpan = 1024;
  explicit StartGraph(std::int32_t max_side) : nodes_(static_cast<std::size_t>((max_side + 2) * (max_side + 2))) {}

  /// None of the grid's cells is free.
  void clear(Grid grid) noexcept;
  /// Half of a step's cost; 0: not free.
  void set_rate(std::int32_t n, std::uint32_t rate) noexcept { nodes_[static_cast<std::size_t>(n)].rate = rate; }
  [[nodiscard]] std::int32_t at(std::int32_t i, std::int32_t j) const noexcept { return (j + 1) * width_ + i + 1; }
  [[nodiscard]] std::uint32_t rate(std::int32_t n) const noexcept { return nodes_[static_cast<std::size_t>(n)].rate; }
  [[nodiscard]] std::uint32_t& cost(std::int32_t n) noexcept { return nodes_[static_cast<std::size_t>(n)].cost; }
  [[nodiscard]] static std::uint32_t limit() noexcept { return kFarthest; }
  template <class May, class Visit>
  void for_each_step(std::int32_t n, const May& may, const Visit& visit) const noexcept;

 private:
  struct Node {
    std::uint32_t cost, rate;
  };
  std::vector<Node> nodes_;
  std::int32_t width_ = 0;
};

/// The start field of one goal. Memory for grids up to `max_side` cells in the constructor.
class StartField {
 public:
  explicit StartField(std::int32_t max_side);
  /// Fills `psi` by rows: cell::kNotFree where there is no clearance, cell::kUnreachable where there is no way. `goal`:
  /// a free cell. False where the queue was full: the field is then none.
  [[nodiscard]] bool settle(Grid grid, std::int32_t goal, const float* clearance, float* psi) noexcept;
  /// Half of a step's cost in a cell, and a cell's cost; of the last field.
  [[nodiscard]] std::uint32_t rate(std::int32_t i, std::int32_t j) const noexcept {
    return graph_.rate(graph_.at(i, j));
  }
  [[nodiscard]] std::uint32_t cost(std::int32_t i, std::int32_t j) noexcept { return graph_.cost(graph_.at(i, j)); }

 private:
  std::vector<std::uint16_t> table_;
  StartGraph graph_;
  field::Shortest queue_;
};

}  // namespace jaywalk::paper
