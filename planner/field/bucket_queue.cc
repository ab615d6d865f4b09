#include "planner/field/bucket_queue.h"

#include <algorithm>
#include <utility>

namespace jaywalk::field {
namespace {
constexpr std::int32_t kNone = -1;  ///< end of a list of chunks; nothing queued

std::size_t at(std::int32_t n) { return static_cast<std::size_t>(n); }
}  // namespace

BucketQueue::BucketQueue(std::int32_t max_side, std::size_t entries)
    : nodes_(static_cast<std::size_t>((max_side + 2) * (max_side + 2))), chunks_(entries / kChunk + kBuckets) {}

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
  std::fill_n(buckets_, kBuckets, Bucket{kNone, kNone, 0, 0});
  queued_ = 0;
  full_ = false;
}

void BucketQueue::push(std::int32_t n, std::uint32_t bucket) noexcept {
  Bucket& into = buckets_[bucket % kBuckets];
  if (into.first == kNone || into.filled == kChunk) {
    if (spare_ == kNone) {
      full_ = true;
      return;
    }
    const std::int32_t chunk = spare_;
    spare_ = std::exchange(chunks_[at(chunk)].next, kNone);
    if (into.first == kNone) {
      into = {chunk, chunk, 0, 0};
    } else {
      chunks_[at(into.last)].next = chunk;
      into.last = chunk;
      into.filled = 0;
    }
  }
  chunks_[at(into.last)].cells[into.filled++] = n;
  ++queued_;
}

std::int32_t BucketQueue::pop(Bucket& from) noexcept {
  if (from.first == kNone) return kNone;
  Chunk& chunk = chunks_[at(from.first)];
  const std::int32_t n = chunk.cells[from.read++];
  --queued_;
  const bool was_last = from.first == from.last;
  if (from.read == (was_last ? from.filled : kChunk)) {
    const std::int32_t emptied = from.first;
    from.first = was_last ? kNone : chunk.next;
    from.read = 0;
    chunk.next = spare_;
    spare_ = emptied;
  }
  return n;
}

/// `bucket`: the one that is being emptied.
inline void BucketQueue::relax(std::int32_t to, std::uint32_t through, std::uint32_t bucket) noexcept {
  Node& there = nodes_[at(to)];
  if (through >= there.cost) return;
  const std::uint32_t into = through >> kBucketShift;
  const bool is_queued_there = there.cost >> kBucketShift == into && into != bucket;
  there.cost = through;
  if (!is_queued_there) push(to, into);
}

void BucketQueue::step_from(std::int32_t n, std::int32_t width, std::uint32_t bucket) noexcept {
  const Node* node = &nodes_[at(n)];
  const Node here = *node;
  const std::uint32_t east = node[1].rate, west = node[-1].rate, north = node[width].rate, south = node[-width].rate;
  relax(n + 1, here.cost + cell::straight_step(here.rate, east), bucket);
  relax(n - 1, here.cost + cell::straight_step(here.rate, west), bucket);
  relax(n + width, here.cost + cell::straight_step(here.rate, north), bucket);
  relax(n - width, here.cost + cell::straight_step(here.rate, south), bucket);
  const auto across = [&](std::int32_t to, std::uint32_t a, std::uint32_t b) {
    if (a == 0 || b == 0) return;
    const std::uint32_t rate = nodes_[at(to)].rate;
    relax(to, here.cost + cell::diagonal_step(here.rate, rate, a, b), bucket);
  };
  across(n + width + 1, east, north), across(n + width - 1, west, north);
  across(n - width + 1, east, south), across(n - width - 1, west, south);
}

bool BucketQueue::settle(Grid grid, std::int32_t goal, const std::uint16_t* rate, std::uint32_t* cost) noexcept {
  const std::int32_t width = grid.side + 2;
  load(grid, rate);
  const std::int32_t first = (goal / grid.side + 1) * width + goal % grid.side + 1;
  nodes_[at(first)].cost = 0;
  push(first, 0);
  for (std::uint32_t bucket = 0; queued_ > 0; ++bucket) {
    for (std::int32_t n = 0; (n = pop(buckets_[bucket % kBuckets])) != kNone;) {
      const std::uint32_t reached = nodes_[at(n)].cost;
      if (reached >> kBucketShift == bucket && reached < kFarthest) step_from(n, width, bucket);
    }
  }
  for (std::int32_t j = 0; j < grid.side; ++j) {
    const Node* row = &nodes_[at((j + 1) * width + 1)];
    for (std::int32_t i = 0; i < grid.side; ++i) cost[grid.at(i, j)] = row[i].rate == 0 ? kNoWay : row[i].cost;
  }
  return !full_;
}

}  // namespace jaywalk::field
