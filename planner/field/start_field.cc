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

BucketQueue::BucketQueue(std::int32_t max_cells)
    : next_(static_cast<std::size_t>(max_cells)), previous_(static_cast<std::size_t>(max_cells), kNotQueued) {
  for (std::int32_t& head : heads_) head = kNobody;
}

void BucketQueue::insert(std::int32_t cell, std::uint32_t cost) noexcept {
  std::int32_t& head = heads_[(cost >> kBucketShift) % kBuckets];
  const auto c = static_cast<std::size_t>(cell);
  next_[c] = head;
  previous_[c] = kNobody;
  if (head != kNobody) previous_[static_cast<std::size_t>(head)] = cell;
  head = cell;
  ++queued_;
}

void BucketQueue::remove(std::int32_t cell, std::uint32_t cost) noexcept {
  const auto c = static_cast<std::size_t>(cell);
  if (previous_[c] == kNobody) {
    heads_[(cost >> kBucketShift) % kBuckets] = next_[c];
  } else {
    next_[static_cast<std::size_t>(previous_[c])] = next_[c];
  }
  if (next_[c] != kNobody) previous_[static_cast<std::size_t>(next_[c])] = previous_[c];
  previous_[c] = kNotQueued;
  --queued_;
}

void BucketQueue::settle(Grid grid, std::int32_t goal, const std::uint16_t* rate, std::uint32_t* cost) noexcept {
  insert(goal, 0);
  const auto relax = [&](std::int32_t from, std::int32_t to) {
    if (rate[to] == 0) return;
    const std::uint32_t through = cost[from] + rate[from] + rate[to];
    if (through >= cost[to]) return;
    if (previous_[static_cast<std::size_t>(to)] != kNotQueued) remove(to, cost[to]);
    cost[to] = through;
    insert(to, through);
  };
  for (std::uint32_t bucket = 0; queued_ > 0; ++bucket) {
    while (heads_[bucket % kBuckets] != kNobody) {
      const std::int32_t c = heads_[bucket % kBuckets];
      remove(c, cost[c]);
      const std::int32_t i = c % grid.side;
      if (i > 0) relax(c, c - 1);
      if (i < grid.side - 1) relax(c, c + 1);
      if (c >= grid.side) relax(c, c - grid.side);
      if (c < grid.cells() - grid.side) relax(c, c + grid.side);
    }
  }
}

}  // namespace jaywalk::field
