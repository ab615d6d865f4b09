#include "planner/field/start_field.h"

#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk::field {
namespace {
constexpr std::int32_t kNobody = -1;     ///< end of a bucket's list
constexpr std::int32_t kNotQueued = -2;  ///< in `previous_`
}  // namespace

std::vector<std::uint16_t> rate_table(std::int32_t max_side) {
  std::vector<std::uint16_t> table(static_cast<std::size_t>(4 * (max_side + 4)));
  for (std::size_t quarter = 0; quarter < table.size(); ++quarter) {
    const double width = static_cast<double>(quarter) / 4.0;
    const double cosh_rate = 2.0 - cos(kPi / (width + 1.0));
    const double rate = log(cosh_rate + std::sqrt(cosh_rate * cosh_rate - 1.0));
    table[quarter] = static_cast<std::uint16_t>(std::floor(rate / 2.0 * static_cast<double>(kCostsPerPsi) + 0.5));
  }
  return table;
}

BucketQueue::BucketQueue(std::int32_t max_side) : nodes_(static_cast<std::size_t>((max_side + 2) * (max_side + 2))) {
  for (std::int32_t& head : heads_) head = kNobody;
}

void BucketQueue::load(Grid grid, const std::uint16_t* rate) noexcept {
  const std::int32_t width = grid.side + 2;
  for (std::int32_t n = 0; n < width * width; ++n) node(n) = {kNoWay, 0, kNobody, kNotQueued};
  for (std::int32_t j = 0; j < grid.side; ++j) {
    for (std::int32_t i = 0; i < grid.side; ++i) node((j + 1) * width + i + 1).rate = rate[grid.at(i, j)];
  }
}

void BucketQueue::insert(std::int32_t n) noexcept {
  std::int32_t& head = heads_[(node(n).cost >> kBucketShift) % kBuckets];
  node(n).next = head;
  node(n).previous = kNobody;
  if (head != kNobody) node(head).previous = n;
  head = n;
  ++queued_;
}

void BucketQueue::remove(std::int32_t n) noexcept {
  Node& here = node(n);
  if (here.previous == kNobody) {
    heads_[(here.cost >> kBucketShift) % kBuckets] = here.next;
  } else {
    node(here.previous).next = here.next;
  }
  if (here.next != kNobody) node(here.next).previous = here.previous;
  here.previous = kNotQueued;
  --queued_;
}

void BucketQueue::relax(const Node& from, std::int32_t to) noexcept {
  Node& there = node(to);
  const std::uint32_t through = from.cost + from.rate + there.rate;
  if (there.rate == 0 || through >= there.cost) return;
  if (there.previous != kNotQueued) remove(to);
  there.cost = through;
  insert(to);
}

void BucketQueue::settle(Grid grid, std::int32_t goal, const std::uint16_t* rate, std::uint32_t* cost) noexcept {
  const std::int32_t width = grid.side + 2;
  load(grid, rate);
  const std::int32_t first = (goal / grid.side + 1) * width + goal % grid.side + 1;
  node(first).cost = 0;
  insert(first);
  for (std::uint32_t bucket = 0; queued_ > 0; ++bucket) {
    while (heads_[bucket % kBuckets] != kNobody) {
      const std::int32_t n = heads_[bucket % kBuckets];
      remove(n);
      const Node here = node(n);
      for (const std::int32_t to : {n - 1, n + 1, n - width, n + width}) relax(here, to);
    }
  }
  for (std::int32_t j = 0; j < grid.side; ++j) {
    for (std::int32_t i = 0; i < grid.side; ++i) cost[grid.at(i, j)] = node((j + 1) * width + i + 1).cost;
  }
}

}  // namespace jaywalk::field
