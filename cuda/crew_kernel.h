#pragma once
// A crew of a device's threads: one kernel runs a whole order. How its blocks meet is the only difference between a
// cooperative launch, for any number of blocks, and a thread block cluster, whose blocks meet several times faster.
#include <cooperative_groups.h>

#include <cstdint>

#include "planner/field/start_tiles.h"
#include "planner/field/strips.h"

namespace jaywalk {

/// A block's own, of as many bytes as its launch asks for.
extern __shared__ unsigned char block_memory[];

/// Threads of a block: what a processor needs to hide its memory's latency; more would leave a thread fewer registers
/// than the stages want (docs/explanation/decisions/gpu.md).
inline constexpr int kBlockThreads = 512;
/// Cells that the first block takes alone: sixteen of each thread take about as long as a crew to meet.
inline constexpr std::int32_t kMostAlone = 8192;

/// Between two looks at whether a block has something to do: less than a tile takes, and other blocks' way to memory
/// stays free.
inline constexpr unsigned kPause_ns = 200;

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
  static __device__ std::int32_t block() { return static_cast<std::int32_t>(blockIdx.x); }
  static __device__ std::int32_t blocks() { return static_cast<std::int32_t>(gridDim.x); }
  static __device__ bool in_first_block() { return blockIdx.x == 0; }
  static __device__ std::int32_t most_alone() { return kMostAlone; }
  static __device__ std::int32_t log2_of(std::int32_t n) { return 31 - __clz(n); }
  static __device__ void meet_block() { __syncthreads(); }
  JAYWALK_APART static void meet_crew() { cooperative_groups::this_grid().sync(); }
  static __device__ void* memory() { return block_memory; }
  /// Past the processor's own cache, which does not see what others write.
  template <class T>
  static __device__ T peek(const T* at) {
    return *static_cast<const volatile T*>(at);
  }
  template <class T>
  static __device__ void put(T* at, T value) {
    *static_cast<volatile T*>(at) = value;
  }
  static __device__ void lower(std::uint32_t* at, std::uint32_t value) { atomicMin(at, value); }
  static __device__ void set_bits(std::int32_t* at, std::int32_t bits) { atomicOr(at, bits); }
  static __device__ std::int32_t swap(std::int32_t* at, std::int32_t value) { return atomicExch(at, value); }
  static __device__ std::int32_t add(std::int32_t* at, std::int32_t value) { return atomicAdd(at, value); }
  static __device__ void fence() { __threadfence(); }
  static __device__ void pause() { __nanosleep(kPause_ns); }
  JAYWALK_APART static field::Counted sum_of_block(field::Counted mine) {
    constexpr unsigned kWarp = 32, kAll = 0xffffffffU;
    __shared__ std::int32_t cells[kBlockThreads / kWarp], joined[kBlockThreads / kWarp];
    for (int by = kWarp / 2; by > 0; by /= 2) {
      mine.cells += __shfl_xor_sync(kAll, mine.cells, by);
      mine.joined += __shfl_xor_sync(kAll, mine.joined, by);
    }
    __syncthreads();  // an earlier sum has been read
    if (threadIdx.x % kWarp == 0) cells[threadIdx.x / kWarp] = mine.cells, joined[threadIdx.x / kWarp] = mine.joined;
    __syncthreads();
    field::Counted sum;
    for (unsigned k = 0; k < kBlockThreads / kWarp; ++k) sum.cells += cells[k], sum.joined += joined[k];
    return sum;
  }
};

/// The blocks of one cluster. Only where code for compute capability 9.0 or newer is in the program.
struct PlaceInCluster : PlaceInGrid {
  JAYWALK_APART static void meet_crew() {
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
