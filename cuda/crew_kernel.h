#pragma once
// A crew of a device's threads: one kernel runs a whole order. How its blocks meet is the only difference between a
// cooperative launch, for any number of blocks, and a thread block cluster, whose blocks meet several times faster.
#include <cooperative_groups.h>

#include <cstdint>

#include "planner/field/crew.h"

namespace jaywalk {

/// Threads of a block: what a processor needs to hide its memory's latency; more would leave a thread fewer registers
/// than the stages want (docs/decisions/0012-a-crew-runs-the-order.md).
inline constexpr int kBlockThreads = 512;
/// Cells that the first block takes alone: sixteen of each thread take about as long as a crew to meet.
inline constexpr std::int32_t kMostAlone = 8192;

/// The blocks of a cooperative launch. Warps are numbered round the blocks, so that a step of few visits, each of many
/// cells, is spread over all processors, and neighbours in a warp stay neighbours.
struct PlaceInGrid {
  static __device__ std::int32_t thread() {
    const unsigned warp = threadIdx.x / 32;
    return static_cast<std::int32_t>((warp * gridDim.x + blockIdx.x) * 32 + threadIdx.x % 32);
  }
  static __device__ std::int32_t threads() { return static_cast<std::int32_t>(gridDim.x) * block_threads(); }
  static __device__ std::int32_t block_thread() { return static_cast<std::int32_t>(threadIdx.x); }
  static __device__ std::int32_t block_threads() { return kBlockThreads; }
  static __device__ bool in_first_block() { return blockIdx.x == 0; }
  static __device__ std::int32_t most_alone() { return kMostAlone; }
  static __device__ std::int32_t log2_of(std::int32_t n) { return 31 - __clz(n); }
  static __device__ void meet_block() { __syncthreads(); }
  static __device__ void meet_crew() { cooperative_groups::this_grid().sync(); }
};

/// The blocks of one cluster. Only where code for compute capability 9.0 or newer is in the program.
struct PlaceInCluster : PlaceInGrid {
  static __device__ void meet_crew() {
#if __CUDA_ARCH__ >= 900
    cooperative_groups::this_cluster().sync();
#endif
  }
};

/// `order` stays where it was handed over, in constant memory.
template <class Place, class Order>
__global__ void __launch_bounds__(kBlockThreads, 1)
    run_order(const __grid_constant__ Order order, const __grid_constant__ field::CrewNotes notes) {
  field::Crew<Place> crew(Place{}, notes);
  order(crew);
}

}  // namespace jaywalk
