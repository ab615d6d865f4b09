#pragma once
// The graph that the time to go is settled on: cells, and steps to sixteen neighbours in integer costs.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/cost_to_go/shortest.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/window.h"

namespace jaywalk::field {

/// A step costs the sum of both cells' rates times its length; 64 units are half a cell.
inline constexpr std::uint32_t kStraightLength = 64, kDiagonalLength = 91, kKnightLength = 143;
inline constexpr std::uint32_t kRateOfOpenGround = 16;
inline constexpr std::uint32_t kCostsPerCell = 2U * kRateOfOpenGround * kStraightLength;

/// A step to one of sixteen neighbours: straight, diagonal, or a knight's move. It is open where the cells (di / 2,
/// dj / 2) and (di - di / 2, dj - dj / 2) from its start are free: of a knight's move those that it passes between, of
/// others its ends.
struct CellStep {
  std::int32_t di, dj;
  std::uint32_t length;
};
inline constexpr std::int32_t kCellSteps = 16;
/// The k-th of them.
JAYWALK_CELL constexpr CellStep cell_step(std::int32_t k) {
  const std::int32_t a = (k & 2) == 0 ? 1 : -1, b = (k & 1) == 0 ? 1 : -1;
  if (k < 4) return {k < 2 ? b : 0, k < 2 ? 0 : b, kStraightLength};
  if (k < 8) return {a, b, kDiagonalLength};
  return {k < 12 ? 2 * a : a, k < 12 ? b : 2 * b, kKnightLength};
}

/// Cost of the way from a cell; half of what a straight step among such cells costs, a unit of its length (0: not
/// free).
struct CellNode {
  std::uint32_t cost, rate;
};

/// The steps between cells, on the processor and on a device; plain values. Nodes lie by rows of `width`, with a ring
/// of two about them that are not free, so that a step asks for no border.
struct CellSteps {
  static constexpr std::uint32_t kNone = kNoWay, kSpan = 8 * kCostsPerCell;
  static constexpr std::uint32_t kEverywhere = kNoWay - (1U << 24);  ///< a step costs less than the difference

  const CellNode* nodes = nullptr;
  std::int32_t width = 0;

  /// may(to, cost) is asked before what lies between is looked at.
  template <class May, class Visit>
  JAYWALK_CELL void step(std::int32_t n, const CellStep& step, const May& may, const Visit& visit) const {
    const CellNode* const here = nodes + n;
    const std::int32_t away = step.dj * width + step.di;
    const std::uint32_t rate = here[away].rate, cost = (here->rate + rate) * step.length;
    if (rate == 0 || here->rate == 0 || !may(n + away, cost)) return;
    const std::int32_t between = step.dj / 2 * width + step.di / 2;
    if (here[between].rate != 0 && here[away - between].rate != 0) visit(n + away, cost);
  }
  /// The k-th step of kCellSteps.
  template <class May, class Visit>
  JAYWALK_CELL void step(std::int32_t n, std::int32_t k, const May& may, const Visit& visit) const {
    step(n, cell_step(k), may, visit);
  }
  [[nodiscard]] JAYWALK_CELL static std::int32_t count(std::int32_t) { return kCellSteps; }
  /// Cells at this cost or beyond it are not stepped from: `more` beyond a cost.
  [[nodiscard]] JAYWALK_CELL static std::uint32_t end(std::uint32_t there, std::uint32_t more) {
    return there < kEverywhere - more ? there + more : kEverywhere;
  }
};

/// A window's cells with CellSteps's ring about them. What Shortest wants of a graph is here.
class CellGraph {
 public:
  using Cost = std::uint32_t;
  static constexpr std::uint32_t kSpan = CellSteps::kSpan;
  static constexpr std::int32_t kNone = -1;
  static constexpr std::int32_t kRing = 2;  ///< cells

  static constexpr std::array<CellStep, kCellSteps> kSteps = [] {
    std::array<CellStep, kCellSteps> steps{};
    for (std::int32_t k = 0; k < kCellSteps; ++k) steps[static_cast<std::size_t>(k)] = cell_step(k);
    return steps;
  }();

  /// Takes memory for grids up to `max_side` cells.
  explicit CellGraph(std::int32_t max_side) : nodes_(size_for(max_side)) {}
  [[nodiscard]] static constexpr std::size_t size_for(std::int32_t max_side) {
    return static_cast<std::size_t>((max_side + 2 * kRing) * (max_side + 2 * kRing));
  }

  /// From now on cells are those of this grid.
  void take_grid(Grid grid) noexcept { width_ = grid.side + 2 * kRing; }
  /// All nodes, the ring's included, by rows.
  [[nodiscard]] CellNode* nodes() noexcept { return nodes_.data(); }
  /// No cell is free, none has a cost.
  void clear() noexcept { std::fill_n(nodes_.begin(), width_ * width_, CellNode{kNoWay, 0}); }
  [[nodiscard]] std::int32_t at(std::int32_t i, std::int32_t j) const noexcept {
    return (j + kRing) * width_ + i + kRing;
  }
  [[nodiscard]] std::int32_t at(CellIndex cell) const noexcept { return at(cell.i, cell.j); }
  [[nodiscard]] CellIndex cell_of(std::int32_t n) const noexcept { return {n % width_ - kRing, n / width_ - kRing}; }
  /// Half of what a straight step among such cells costs, a unit of its length; 0: not free.
  void set_rate(std::int32_t n, std::uint32_t rate) noexcept {
    CellNode& node = nodes_[static_cast<std::size_t>(n)];
    node.rate = rate;
    if (rate == 0) node.cost = kNoWay;
  }
  [[nodiscard]] std::uint32_t rate(std::int32_t n) const noexcept { return nodes_[static_cast<std::size_t>(n)].rate; }
  [[nodiscard]] std::uint32_t cost(std::int32_t n) const noexcept { return nodes_[static_cast<std::size_t>(n)].cost; }
  [[nodiscard]] bool is_free(std::int32_t n) const noexcept { return rate(n) != 0; }
  [[nodiscard]] bool has_way(std::int32_t n) const noexcept { return cost(n) != kNoWay; }
  /// Of settled costs: the neighbour through which a cell has its cost; kNone for one that was given its cost, or has
  /// none.
  [[nodiscard]] std::int32_t next(std::int32_t n) const noexcept {
    const std::uint32_t own = cost(n);
    std::int32_t found = kNone;
    for_each_step(
        n,
        [&](std::uint32_t there, std::uint32_t step) { return found == kNone && there < own && there + step == own; },
        [&](std::int32_t to, std::uint32_t) { found = to; });
    return found;
  }

  /// The cell whose cost is given, or kNone.
  void seed(std::int32_t n) noexcept { seed_ = n; }
  /// Ways end where they cost `more` than that of cell n; where it has none, nowhere.
  void end_beyond(std::int32_t n, std::uint32_t more) noexcept { end_ = n, more_ = more; }
  /// They end where they do now, whatever the way of cell n comes to cost.
  void keep_end() noexcept { limit_ = limit(), end_ = kNone; }
  /// Whether all ways are known that cost at most `more` than that of cell n.
  [[nodiscard]] bool reaches(std::int32_t n, std::uint32_t more) const noexcept { return beyond(n, more) <= limit(); }

  [[nodiscard]] std::uint32_t& cost(std::int32_t n) noexcept { return nodes_[static_cast<std::size_t>(n)].cost; }
  [[nodiscard]] bool is_open(std::int32_t n) const noexcept {
    return n != seed_ && nodes_[static_cast<std::size_t>(n)].rate != 0;
  }
  [[nodiscard]] std::uint32_t limit() const noexcept { return end_ == kNone ? limit_ : beyond(end_, more_); }
  [[nodiscard]] std::uint32_t beyond(std::int32_t n, std::uint32_t more) const noexcept {
    return CellSteps::end(cost(n), more);
  }

  template <class May, class Visit>
  void for_each_step(std::int32_t n, const May& may, const Visit& visit) const noexcept {
    const CellNode* const nodes = nodes_.data();
    const CellSteps steps{nodes, width_};
    const auto asked = [&](std::int32_t to, std::uint32_t cost) { return may(nodes[to].cost, cost); };
    if (nodes[n].rate == 0) return;
    for (const CellStep& step : kSteps) steps.step(n, step, asked, visit);
  }
  template <class Visit>
  void for_each_near(std::int32_t n, const Visit& visit) const noexcept {
    for (const CellStep& step : kSteps) visit(n + step.dj * width_ + step.di);
  }

 protected:
  std::vector<CellNode> nodes_;
  std::int32_t width_ = 0;

 private:
  std::int32_t seed_ = kNone;
  std::int32_t end_ = kNone;
  std::uint32_t more_ = 0, limit_ = CellSteps::kEverywhere;
};

}  // namespace jaywalk::field
