#pragma once
// Shortest ways in integer costs by near and far piles (Davidson and others 2014), and their repair where steps have
// become dearer, cheaper or none.
//
// Costs are the fixed point of cost[n] = min(cost[c] + step(c, n)) over the cells c whose cost is below a limit. No
// step is free, so the fixed point is unique: what a repair leaves are the costs of a computation from nothing, to the
// last bit. The repair is Ramalingam and Reps's (1996): what is no longer held up by a lower neighbour is forgotten,
// and so on; then the cells about all that was forgotten or has changed offer their costs anew.
//
// Graph says what the cells and the steps are:
//   Cost, kSpan                  an unsigned type; costs that a near pile spans
//   cost(n)                      reference; kNoWay where there is none
//   limit()                      cells at this cost or beyond it are not stepped from
//   for_each_step(n, may, visit) visit(to, step) for the cells that n may be left for; of a repair the same both ways.
//                                may(cost, least) is asked first, with what the cell costs now and what the step costs
//                                at least: most are of no interest, and what a step costs is the dearer question
// and for repairs:
//   is_open(n)                   whether n may be passed and its cost is not given
//   for_each_near(n, visit)      visit(to) for the cells to which a step depends on what n is
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace jaywalk::field {

inline constexpr std::uint32_t kNoWay = 0xffffffffU;

class Shortest {
 public:
  /// Takes memory for piles of `entries` each, and for repairs among `cells` cells.
  Shortest(std::size_t cells, std::size_t entries)
      : near_(entries), far_(entries), seen_(cells), open_(cells), forgotten_(cells / kWorthwhile) {}

  /// Nothing is offered.
  void clear() noexcept {
    near_count_ = far_count_ = 0;
    end_ = 0;
    least_ = kNoWay;
    full_ = false;
  }

  /// Gives a cell a lower cost, from which its neighbours' are settled later.
  template <class Graph>
  void offer(Graph& graph, std::int32_t n, std::uint32_t cost) noexcept {
    if (cost >= graph.cost(n)) return;
    graph.cost(n) = static_cast<typename Graph::Cost>(cost);
    if (cost < end_) return put(near_, near_count_, {n, cost});
    put(far_, far_count_, {n, cost});
    least_ = std::min(least_, cost);
  }

  /// True where nothing is offered.
  [[nodiscard]] bool is_empty() const noexcept { return near_count_ + far_count_ == 0; }
  /// Settles the offers to the fixed point. False when a pile was full: costs are then not settled.
  template <class Graph>
  [[nodiscard]] bool settle(Graph& graph) noexcept {
    while (far_count_ > 0 && least_ < graph.limit()) {
      take_span(graph);
      for (std::size_t k = 0; k < near_count_; ++k) step_from(graph, near_[k]);
      near_count_ = 0;
    }
    return !full_;
  }

  /// Mends the fixed point after steps of the `changed` cells have changed; closed ones have the cost kNoWay. False
  /// when that would take long: costs are then not settled.
  template <class Graph>
  [[nodiscard]] bool repair(Graph& graph, std::span<const std::int32_t> changed) noexcept {
    clear();
    ++round_;
    open_count_ = forgotten_count_ = 0;
    for (const std::int32_t n : changed) {
      look_at(n);
      graph.for_each_near(n, [this](std::int32_t to) { look_at(to); });
    }
    const std::size_t touched = open_count_;
    std::size_t next = 0;
    while (next < open_count_) {
      if (open_count_ + kMostNear > open_.size() || forgotten_count_ == forgotten_.size()) return false;
      forget_unless_held_up(graph, open_[next++]);
    }
    for (std::size_t k = 0; k < touched; ++k) offer_best(graph, open_[k]);
    for (std::size_t k = 0; k < forgotten_count_; ++k) offer_best(graph, forgotten_[k]);
    return settle(graph);
  }

 private:
  static constexpr std::size_t kMostNear = 16;
  static constexpr std::size_t kWorthwhile = 5;  ///< more than a fifth of all cells: from nothing is sooner

  /// A cell that had this cost when it was offered.
  struct Entry {
    std::int32_t cell;
    std::uint32_t cost;
  };

  void look_at(std::int32_t n) noexcept {
    std::uint32_t& seen = seen_[static_cast<std::size_t>(n)];
    if (std::exchange(seen, round_) != round_) open_[open_count_++] = n;
  }

  template <class Graph>
  void forget_unless_held_up(Graph& graph, std::int32_t n) noexcept {
    const std::uint32_t old = graph.cost(n);
    if (!graph.is_open(n) || old == kNoWay || is_held_up(graph, n, old)) return;
    graph.cost(n) = kNoWay;
    forgotten_[forgotten_count_++] = n;
    graph.for_each_step(
        n, [old](std::uint32_t cost, std::uint32_t least) { return cost >= old + least && cost != kNoWay; },
        [&](std::int32_t to, std::uint32_t step) {
          if (graph.cost(to) == old + step) open_[open_count_++] = to;
        });
  }

  template <class Graph>
  [[nodiscard]] static bool is_held_up(const Graph& graph, std::int32_t n, std::uint32_t old) noexcept {
    const std::uint32_t limit = graph.limit();
    bool held_up = false;
    graph.for_each_step(
        n,
        [&](std::uint32_t cost, std::uint32_t least) {
          return !held_up && cost < old && cost + least <= old && cost < limit;
        },
        [&](std::int32_t from, std::uint32_t step) { held_up |= graph.cost(from) + step == old; });
    return held_up;
  }

  template <class Graph>
  void offer_best(Graph& graph, std::int32_t n) noexcept {
    if (!graph.is_open(n)) return;
    const std::uint32_t limit = graph.limit();
    std::uint32_t best = kNoWay;
    graph.for_each_step(
        n, [&](std::uint32_t cost, std::uint32_t least) { return cost < limit && cost + least < best; },
        [&](std::int32_t from, std::uint32_t step) { best = std::min(best, graph.cost(from) + step); });
    offer(graph, n, best);
  }

  /// The near pile of the next span: what is offered below its end meanwhile is stepped from as well.
  template <class Graph>
  void take_span(Graph& graph) noexcept {
    end_ = least_ / Graph::kSpan * Graph::kSpan + Graph::kSpan;
    least_ = kNoWay;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < far_count_; ++k) {
      const Entry entry = far_[k];
      if (graph.cost(entry.cell) != entry.cost) continue;
      if (entry.cost < end_) {
        put(near_, near_count_, entry);
      } else {
        far_[kept++] = entry;
        least_ = std::min(least_, entry.cost);
      }
    }
    far_count_ = kept;
  }

  template <class Graph>
  void step_from(Graph& graph, const Entry& entry) noexcept {
    const std::uint32_t cost = entry.cost;
    if (graph.cost(entry.cell) != cost || cost >= graph.limit()) return;
    graph.for_each_step(
        entry.cell, [cost](std::uint32_t there, std::uint32_t least) { return there > cost + least; },
        [&](std::int32_t to, std::uint32_t step) { offer(graph, to, cost + step); });
  }

  void put(std::vector<Entry>& pile, std::size_t& count, const Entry& entry) noexcept {
    if (count == pile.size()) return void(full_ = true);
    pile[count++] = entry;
  }

  std::vector<Entry> near_, far_;
  std::size_t near_count_ = 0, far_count_ = 0;
  std::uint32_t end_ = 0;         ///< of the near pile's span
  std::uint32_t least_ = kNoWay;  ///< of the far pile
  bool full_ = false;

  std::vector<std::uint32_t> seen_;  ///< in which round a cell was looked at last
  std::uint32_t round_ = 0;
  std::vector<std::int32_t> open_, forgotten_;
  std::size_t open_count_ = 0, forgotten_count_ = 0;
};

}  // namespace jaywalk::field
