#pragma once
// Shortest ways in integer costs on a device, by near and far piles (Davidson and others 2014): what costs less than
// the end of a span is stepped from until nothing falls below it any more, the rest waits for its span. The fixed point
// is Shortest's, whatever the order.
//
// Graph says what the nodes and the steps are, by plain values:
//   kThreads, kSpan              threads that share a node's steps; costs of a span
//   costs                        LoweredCosts of all nodes
//   limit()                      nodes at this cost or beyond it are not stepped from; falls as costs do
//   count(n), step(n, k, may, visit)
//                                steps from a node; visit(to, cost) for the k-th if may(to, least cost)
#include <cuda_runtime.h>

#include <cstdint>

namespace jaywalk {

/// Costs that any thread may lower; read past a processor's own cache alone, which does not see what others write.
class LoweredCosts {
 public:
  LoweredCosts(std::uint32_t* costs, std::int32_t stride) : costs_(costs), stride_(stride) {}
  [[nodiscard]] __device__ std::uint32_t peek(std::int32_t n) const {
    return *static_cast<const volatile std::uint32_t*>(costs_ + n * stride_);
  }
  /// Whether it was higher.
  [[nodiscard]] __device__ bool lower(std::int32_t n, std::uint32_t cost) const {
    return atomicMin(costs_ + n * stride_, cost) > cost;
  }

 private:
  std::uint32_t* costs_;
  std::int32_t stride_;
};

/// Memory of the piles: two near ones and two far ones, in turns.
struct Piles {
  static constexpr std::int32_t kRoom = 1 << 17;
  /// A node that had this cost when it was put there.
  struct Entry {
    std::int32_t node;
    std::uint32_t cost;
  };
  /// What a settlement took; for tests, and to know that it is one.
  struct Told {
    std::int32_t seeds = 0;     ///< of the first far pile, put there before
    std::int32_t steps = 0;     ///< that depend on one another
    std::int32_t expanded = 0;  ///< nodes stepped from
    std::int32_t full = 0;      ///< a pile was: nothing is settled
  };

  Entry* pile[4];
  Told* told;

  /// Of all threads of a launch: a node that has a cost to begin with.
  __device__ void sow(std::int32_t node, std::uint32_t cost) const {
    const std::int32_t at = atomicAdd(&told->seeds, 1);
    if (at < kRoom) pile[2][at] = {node, cost};
  }
};

inline constexpr int kPileThreads = 1024;

/// In one block: what one thread put into a pile all others see after a barrier.
template <class Graph>
__global__ void __launch_bounds__(kPileThreads, 1)
    settle_piles(const __grid_constant__ Graph graph, const __grid_constant__ Piles piles) {
  __shared__ int count[4], full, expanded;
  __shared__ std::uint32_t least;  // of the far pile that is being made
  const int me = static_cast<int>(threadIdx.x);
  if (me == 0) {
    const std::int32_t seeds = piles.told->seeds;
    count[0] = count[1] = count[3] = 0, count[2] = seeds;
    full = seeds > Piles::kRoom ? 1 : 0, expanded = 0, least = 0;
  }
  __syncthreads();
  const auto put = [&](int to, std::int32_t node, std::uint32_t cost) {
    const int at = atomicAdd(&count[to], 1);
    if (at < Piles::kRoom) {
      piles.pile[to][at] = {node, cost};
    } else {
      full = 1;
    }
  };
  int near = 0, far = 2, steps = 0;
  for (;;) {
    const std::uint32_t begin = least / Graph::kSpan * Graph::kSpan, end = begin + Graph::kSpan, limit = graph.limit();
    const int waiting_far = count[far];
    if (waiting_far == 0 || begin >= limit || full != 0) break;
    __syncthreads();
    if (me == 0) count[far ^ 1] = count[near] = 0, least = 0xffffffffU;
    __syncthreads();
    const auto put_far = [&](int to, std::int32_t node, std::uint32_t cost) {
      put(to, node, cost);
      atomicMin(&least, cost);
    };
    for (int k = me; k < waiting_far; k += kPileThreads) {
      const Piles::Entry entry = piles.pile[far][k];
      if (entry.cost >= limit || graph.costs.peek(entry.node) != entry.cost) continue;
      if (entry.cost < end) {
        put(near, entry.node, entry.cost);
      } else {
        put_far(far ^ 1, entry.node, entry.cost);
      }
    }
    far ^= 1;
    __syncthreads();
    for (int waiting = count[near]; waiting != 0 && full == 0; waiting = count[near]) {
      __syncthreads();
      if (me == 0) count[near ^ 1] = 0;
      ++steps;
      __syncthreads();
      for (int k = me; k < waiting * Graph::kThreads; k += kPileThreads) {
        const Piles::Entry entry = piles.pile[near][k / Graph::kThreads];
        if (graph.costs.peek(entry.node) != entry.cost) continue;
        const int first = k % Graph::kThreads, of_node = graph.count(entry.node);
        if (first == 0) atomicAdd(&expanded, 1);
        const auto may = [&](std::int32_t to, std::uint32_t cost) { return graph.costs.peek(to) > entry.cost + cost; };
        const auto visit = [&](std::int32_t to, std::uint32_t step) {
          const std::uint32_t cost = entry.cost + step;
          if (cost >= Graph::kNone || !graph.costs.lower(to, cost)) return;
          if (cost < end) {
            put(near ^ 1, to, cost);
          } else {
            put_far(far, to, cost);
          }
        };
        for (int n = first; n < of_node; n += Graph::kThreads) graph.step(entry.node, n, may, visit);
      }
      near ^= 1;
      __syncthreads();
    }
    __syncthreads();
  }
  if (me == 0) piles.told->steps = steps, piles.told->expanded = expanded, piles.told->full = full;
}

}  // namespace jaywalk
