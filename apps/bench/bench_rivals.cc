#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <utility>

#include "apps/bench/bench.h"

namespace jaywalk {
namespace {
constexpr std::int32_t kNoWay = -1;
constexpr std::int32_t kStraight = 10, kDiagonal = 14;
}  // namespace

BenchRivals::BenchRivals(std::int32_t width, std::int32_t height, std::vector<std::uint8_t> free)
    : width_(width), height_(height), stride_(width + 2) {
  const auto cells = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2);
  // The ring lies at column and row -1, which is the last column of the row before: one row of spare cells in front.
  free_.assign(cells + static_cast<std::size_t>(stride_) + 1, 0);
  for (std::int32_t j = 0; j < height; ++j) {
    for (std::int32_t i = 0; i < width; ++i) {
      free_[index({i + 1, j + 1})] =
          free[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
    }
  }
  distance_.resize(free_.size());
  queue_.resize(free_.size());
  phi_.resize(free_.size());
}

void BenchRivals::wavefront(CellIndex goal) {
  std::fill(distance_.begin(), distance_.end(), kNoWay);
  const auto stride = static_cast<std::uint32_t>(stride_);
  std::size_t head = 0, tail = 0;
  queue_[tail++] = static_cast<std::uint32_t>(index({goal.i + 1, goal.j + 1}));
  distance_[queue_[0]] = 0;
  while (head < tail) {
    const std::uint32_t c = queue_[head++];
    for (const std::uint32_t n : {c + 1, c - 1, c + stride, c - stride}) {
      if (free_[n] == 0 || distance_[n] != kNoWay) continue;
      distance_[n] = distance_[c] + 1;
      queue_[tail++] = n;
    }
  }
}

template <class Visit>
void BenchRivals::for_each_step(std::size_t from, const Visit& visit) const {
  const auto stride = static_cast<std::size_t>(stride_);
  const std::size_t east = from + 1, west = from - 1, north = from + stride, south = from - stride;
  for (const std::size_t n : {east, west, north, south})
    if (free_[n] != 0) visit(n, kStraight);
  const auto corner = [&](std::size_t n, std::size_t a, std::size_t b) {
    if (free_[n] != 0 && free_[a] != 0 && free_[b] != 0) visit(n, kDiagonal);
  };
  corner(north + 1, north, east), corner(north - 1, north, west);
  corner(south + 1, south, east), corner(south - 1, south, west);
}

void BenchRivals::dijkstra_buckets(CellIndex goal) {
  std::fill(distance_.begin(), distance_.end(), kNoWay);
  std::array<std::vector<std::uint32_t>, 16> ring;  // more than the dearest step
  const std::size_t first = index({goal.i + 1, goal.j + 1});
  distance_[first] = 0;
  ring[0].push_back(static_cast<std::uint32_t>(first));
  std::size_t queued = 1;
  for (std::int32_t reached = 0; queued > 0; ++reached) {
    std::vector<std::uint32_t>& bucket = ring[static_cast<std::size_t>(reached % 16)];
    for (const std::uint32_t c : bucket) {
      if (distance_[c] != reached) continue;  // found a shorter way meanwhile
      for_each_step(c, [&](std::size_t n, std::int32_t cost) {
        const std::int32_t through = reached + cost;
        if (distance_[n] != kNoWay && distance_[n] <= through) return;
        distance_[n] = through;
        ring[static_cast<std::size_t>(through % 16)].push_back(static_cast<std::uint32_t>(n));
        ++queued;
      });
    }
    queued -= bucket.size();
    bucket.clear();
  }
}

void BenchRivals::dijkstra_heap(CellIndex goal) {
  using Entry = std::pair<std::int32_t, std::uint32_t>;
  std::fill(distance_.begin(), distance_.end(), kNoWay);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> heap;
  const std::size_t first = index({goal.i + 1, goal.j + 1});
  distance_[first] = 0;
  heap.emplace(0, static_cast<std::uint32_t>(first));
  while (!heap.empty()) {
    const auto [reached, c] = heap.top();
    heap.pop();
    if (distance_[c] != reached) continue;
    const std::int32_t here = reached;
    for_each_step(c, [&](std::size_t n, std::int32_t cost) {
      const std::int32_t through = here + cost;
      if (distance_[n] != kNoWay && distance_[n] <= through) return;
      distance_[n] = through;
      heap.emplace(through, static_cast<std::uint32_t>(n));
    });
  }
}

void BenchRivals::hundred_sweeps(CellIndex goal) {
  const auto stride = static_cast<std::size_t>(stride_);
  for (std::size_t c = 0; c < phi_.size(); ++c) phi_[c] = free_[c] != 0 ? 0.5F : 1.0F;
  const std::size_t at_goal = index({goal.i + 1, goal.j + 1});
  phi_[at_goal] = 0.0F;
  for (std::int32_t half = 0; half < 200; ++half) {
    for (std::int32_t j = 1; j <= height_; ++j) {
      for (std::int32_t i = 1 + ((j + half) & 1); i <= width_; i += 2) {
        const std::size_t c = index({i, j});
        if (free_[c] == 0 || c == at_goal) continue;
        phi_[c] = 0.25F * ((phi_[c + 1] + phi_[c - 1]) + (phi_[c + stride] + phi_[c - stride]));
      }
    }
  }
}

}  // namespace jaywalk
