#include "planner/field/bucket_queue.h"

#include <algorithm>
#include <utility>

namespace jaywalk::field {
namespace {
constexpr std::int32_t kNone = -1;  ///< end of a list of chunks; nothing queued

/// Cells that have changed, as a share of all, from which on all is settled anew.
constexpr std::size_t kFewOf = 4;
/// Where a repair would have taken long, so many of the next are not tried.
constexpr int kNotTried = 7;

std::size_t at(std::int32_t n) { return static_cast<std::size_t>(n); }
}  // namespace

BucketQueue::BucketQueue(std::int32_t max_side, std::size_t entries)
    : nodes_(static_cast<std::size_t>((max_side + 2) * (max_side + 2))),
      chunks_(entries / kChunk + kBuckets),
      repair_(max_side == 0 ? 0 : nodes_.size(), max_side == 0 ? 0 : nodes_.size()) {
  changed_.resize(nodes_.size() / kFewOf);  // touched, not only reserved: no page is to be fetched later
  changed_.clear();
}

/// What a repair wants of these ways.
struct BucketQueue::Ways {
  static constexpr std::uint32_t kBucketShift = BucketQueue::kBucketShift;
  Node* nodes;
  std::int32_t width, goal;

  [[nodiscard]] std::uint32_t& cost(std::int32_t n) const { return nodes[n].cost; }
  [[nodiscard]] bool is_open(std::int32_t n) const { return n != goal && nodes[n].rate != 0; }
  [[nodiscard]] static std::uint32_t limit() { return kFarthest; }

  /// A diagonal step costs no less than a straight one among the same rates.
  template <class May, class Visit>
  void for_each_step(std::int32_t n, const May& may, const Visit& visit) const {
    const Node* node = nodes + n;
    const std::uint32_t here = node->rate;
    const auto along = [&](std::int32_t away) {
      const Node there = node[away];
      const std::uint32_t step = cell::straight_step(here, there.rate);
      if (may(there.cost, step) && there.rate != 0) visit(n + away, step);
    };
    along(1), along(-1), along(width), along(-width);
    const auto across = [&](std::int32_t di, std::int32_t dj) {
      const Node there = node[di + dj];
      if (!may(there.cost, cell::straight_step(here, there.rate)) || there.rate == 0) return;
      const std::uint32_t a = node[di].rate, b = node[dj].rate;
      if (a != 0 && b != 0) visit(n + di + dj, cell::diagonal_step(here, there.rate, a, b));
    };
    across(1, width), across(-1, width), across(1, -width), across(-1, -width);
  }
  template <class Visit>
  void for_each_near(std::int32_t n, const Visit& visit) const {
    for (const std::int32_t row : {n - width, n, n + width}) visit(row - 1), visit(row), visit(row + 1);
  }
};

/// Cells that are not free cost nothing: no way to them is shorter.
void BucketQueue::load(Grid grid, const std::uint16_t* rate) noexcept {
  const std::int32_t width = grid.side + 2;
  std::fill_n(nodes_.begin(), width * width, Node{0, 0});
  for (std::int32_t j = 0; j < grid.side; ++j) {
    Node* row = &nodes_[at((j + 1) * width + 1)];
    for (std::int32_t i = 0; i < grid.side; ++i) {
      const std::uint32_t r = rate[grid.at(i, j)];
      row[i] = {r == 0 ? 0 : kNoWay, r};
    }
  }
  for (std::size_t k = 0; k < chunks_.size(); ++k) chunks_[k].next = static_cast<std::int32_t>(k) + 1;
  chunks_.back().next = kNone;
  spare_ = 0;
  std::fill_n(buckets_, kBuckets, Bucket{kNone, kNone, kChunk});
  chunks_in_use_ = 0;
  full_ = false;
}

/// The rows on either side are fetched meanwhile: they are asked for when the entry's turn comes, and on a large grid
/// the front has driven them out of the caches by then.
void BucketQueue::push(std::int32_t n, std::int32_t width, std::uint32_t bucket) noexcept {
  __builtin_prefetch(nodes_.data() + n + width);
  __builtin_prefetch(nodes_.data() + n - width);
  Bucket& into = buckets_[bucket % kBuckets];
  if (into.filled == kChunk) {
    if (spare_ == kNone) {
      full_ = true;
      return;
    }
    const std::int32_t chunk = spare_;
    spare_ = std::exchange(chunks_[at(chunk)].next, kNone);
    (into.first == kNone ? into.first : chunks_[at(into.last)].next) = chunk;
    into.last = chunk;
    into.filled = 0;
    ++chunks_in_use_;
  }
  chunks_[at(into.last)].cells[into.filled++] = n;
}

/// What is queued in it meanwhile is stepped from as well.
void BucketQueue::drain(std::int32_t width, std::uint32_t bucket) noexcept {
  Bucket& from = buckets_[bucket % kBuckets];
  while (from.first != kNone) {
    Chunk& chunk = chunks_[at(from.first)];
    for (std::size_t k = 0; k < (from.first == from.last ? from.filled : kChunk); ++k) {
      const std::int32_t n = chunk.cells[k];
      const std::uint32_t reached = nodes_[at(n)].cost;
      if (reached >> kBucketShift == bucket && reached < kFarthest) step_from(n, width, bucket);
    }
    const std::int32_t emptied = std::exchange(from.first, chunk.next);
    chunk.next = std::exchange(spare_, emptied);
    --chunks_in_use_;
  }
  from.filled = kChunk;
}

/// `bucket`: the one that is being emptied.
inline void BucketQueue::relax(std::int32_t to, std::int32_t width, std::uint32_t through,
                               std::uint32_t bucket) noexcept {
  Node& there = nodes_[at(to)];
  if (through >= there.cost) return;
  const std::uint32_t into = through >> kBucketShift;
  const bool is_queued_there = there.cost >> kBucketShift == into && into != bucket;
  there.cost = through;
  if (!is_queued_there) push(to, width, into);
}

void BucketQueue::step_from(std::int32_t n, std::int32_t width, std::uint32_t bucket) noexcept {
  const Node* node = &nodes_[at(n)];
  const Node here = *node;
  const std::uint32_t east = node[1].rate, west = node[-1].rate, north = node[width].rate, south = node[-width].rate;
  relax(n + 1, width, here.cost + cell::straight_step(here.rate, east), bucket);
  relax(n - 1, width, here.cost + cell::straight_step(here.rate, west), bucket);
  relax(n + width, width, here.cost + cell::straight_step(here.rate, north), bucket);
  relax(n - width, width, here.cost + cell::straight_step(here.rate, south), bucket);
  const auto across = [&](std::int32_t to, std::uint32_t a, std::uint32_t b) {
    const Node there = nodes_[at(to)];
    // Most have been reached for less than a straight step would cost: seen before the dearer questions.
    if (there.cost <= here.cost + cell::straight_step(here.rate, there.rate)) return;
    if (a == 0 || b == 0) return;
    relax(to, width, here.cost + cell::diagonal_step(here.rate, there.rate, a, b), bucket);
  };
  across(n + width + 1, east, north), across(n + width - 1, west, north);
  across(n - width + 1, east, south), across(n - width - 1, west, south);
}

std::int32_t BucketQueue::place(Grid grid, std::int32_t c) noexcept {
  return (c / grid.side + 1) * (grid.side + 2) + c % grid.side + 1;
}

void BucketQueue::settle_anew(Grid grid, std::int32_t goal, const std::uint16_t* rate) noexcept {
  const std::int32_t width = grid.side + 2, first = place(grid, goal);
  load(grid, rate);
  nodes_[at(first)].cost = 0;
  push(first, width, 0);
  for (std::uint32_t bucket = 0; chunks_in_use_ > 0; ++bucket) drain(width, bucket);
  if (full_) settle_in_turn({nodes_.data(), width, first});
}

/// For a queue without room: sweeps over all cells, forward and backward, until no cost changes.
void BucketQueue::settle_in_turn(const Ways& ways) noexcept {
  const std::int32_t end = ways.width * ways.width;
  bool any = true;
  const auto step_from = [&](std::int32_t n) {
    const Node here = ways.nodes[n];
    if (here.rate == 0 || here.cost >= kFarthest) return;
    const auto is_less = [&](std::uint32_t there, std::uint32_t step) { return here.cost + step < there; };
    ways.for_each_step(n, is_less, [&](std::int32_t to, std::uint32_t step) {
      if (is_less(ways.cost(to), step)) ways.cost(to) = here.cost + step, any = true;
    });
  };
  while (any) {
    any = false;
    for (std::int32_t n = 0; n < end; ++n) step_from(n);
    for (std::int32_t n = end; n-- > 0;) step_from(n);
  }
}

/// False where all is to be settled anew.
bool BucketQueue::repair(Grid grid, std::int32_t goal, const std::uint16_t* rate) noexcept {
  if (grid.side != settled_grid_.side || goal != settled_goal_) return false;
  if (not_tried_ > 0) return --not_tried_, false;
  const auto most = static_cast<std::size_t>(grid.cells()) / kFewOf;
  const std::int32_t width = grid.side + 2;
  changed_.clear();
  for (std::int32_t j = 0; j < grid.side; ++j) {
    for (std::int32_t i = 0; i < grid.side; ++i) {
      const std::int32_t n = (j + 1) * width + i + 1;
      const std::uint32_t now = rate[grid.at(i, j)];
      Node& node = nodes_[at(n)];
      if (node.rate == now) continue;
      if (changed_.size() == most) return not_tried_ = kNotTried, false;
      changed_.push_back(n);
      if (node.rate == 0) node.cost = kNoWay;
      if (now == 0) node.cost = 0;
      node.rate = now;
    }
  }
  Ways ways{nodes_.data(), width, place(grid, goal)};
  if (repair_.repair(ways, changed_)) return true;
  not_tried_ = kNotTried;
  return false;
}

void BucketQueue::settle(Grid grid, std::int32_t goal, const std::uint16_t* rate, std::uint32_t* cost) noexcept {
  if (!repair(grid, goal, rate)) settle_anew(grid, goal, rate);
  settled_grid_ = grid, settled_goal_ = goal;
  const std::int32_t width = grid.side + 2;
  for (std::int32_t j = 0; j < grid.side; ++j) {
    const Node* row = &nodes_[at((j + 1) * width + 1)];
    for (std::int32_t i = 0; i < grid.side; ++i) cost[grid.at(i, j)] = row[i].rate == 0 ? kNoWay : row[i].cost;
  }
}

}  // namespace jaywalk::field
