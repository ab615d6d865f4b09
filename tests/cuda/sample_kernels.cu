#include <cmath>
#include <cstring>

#include "tests/cuda/sample_kernels.h"

namespace jaywalk {
extern __shared__ unsigned char block_memory[];
}

namespace jaywalk::test {

__global__ void add_place(int* ints) {
  const unsigned k = blockIdx.x * blockDim.x + threadIdx.x;
  ints[k] = static_cast<int>(k);
}

__global__ void pass_round_cluster(int* ints) {
  int* mine = reinterpret_cast<int*>(block_memory);
  const auto cluster = cooperative_groups::this_cluster();
  const unsigned t = threadIdx.x, rank = cluster.block_rank(), next = (rank + 1) % cluster.num_blocks();
  if (rank == 0 && t == 0) ints[gridDim.x * blockDim.x] = mine[0];
  cluster.sync();
  mine[t] = static_cast<int>(1000 * rank + t);
  cluster.sync();
  ints[rank * blockDim.x + t] = cluster.map_shared_rank(mine, next)[t];
  cluster.sync();
}

__global__ void meet_grid(int* ints) {
  const unsigned k = blockIdx.x * blockDim.x + threadIdx.x;
  if (k == 0) ints[0] = 0;
  cooperative_groups::this_grid().sync();
  atomicAdd(ints, 1);
}

__global__ void meet_by_halves(int*) {
  if (threadIdx.x % 2 == 0) __syncthreads();
}

__global__ void meet_for_ever(int*) {
  for (;;) __syncthreads();
}

__global__ void reduce_warps(int* ints) {
  const unsigned lane = threadIdx.x % 32, warp = (blockIdx.x * blockDim.x + threadIdx.x) / 32;
  if (blockIdx.x == 0 && threadIdx.x == 0) ints[0] = 0;
  auto sum = static_cast<int>(lane);
  for (unsigned by = 16; by > 0; by /= 2) sum += __shfl_down_sync(0xffffffffU, sum, by);
  if (lane == 0) ints[1 + warp] = sum;
  if (__ballot_sync(0xffffffffU, lane < 5) != 31U) ints[1 + warp] = -1;
  if (blockIdx.x == 0) {
    __syncthreads();
    if (lane == 0) atomicAdd(ints, 2);
  }
}

__global__ void nans(int* ints, float nan) {
  const float zero = nan == nan ? 1.0F : 0.0F, infinity = 1.0F / zero;  // what the compiler cannot know
  const float values[] = {nan, nan + 1.0F, zero / zero, infinity - infinity, zero + 1.5F, std::sqrt(zero - 1.0F)};
  std::memcpy(ints, values, sizeof values);
}

}  // namespace jaywalk::test
