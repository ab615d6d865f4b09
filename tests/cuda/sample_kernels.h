#pragma once
// Kernels for tests of the emulated device: each needs one thing of it.
#include <cuda_runtime.h>

#include <cstddef>

namespace jaywalk::test {

struct Launched {
  unsigned blocks, threads;
};

template <class... Arguments>
cudaError_t launch_sample(Launched how, cudaStream_t stream, void (*kernel)(Arguments...), Arguments... arguments) {
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(how.blocks), config.blockDim = dim3(how.threads);
  config.stream = stream;
  return cudaLaunchKernelEx(&config, kernel, arguments...);
}

__global__ void add_place(int* ints);

/// Adds up the numbers of a block's threads by halves, with or without the barriers that it takes.
template <bool kMeets>
__global__ void sum_of_block(int* ints) {
  const unsigned t = threadIdx.x;
  ints[t] = static_cast<int>(t);
  for (unsigned half = blockDim.x / 2; half > 0; half /= 2) {
    if (kMeets) __syncthreads();
    // Unsigned: without barriers it may be poison that is added.
    if (t < half) ints[t] = static_cast<int>(static_cast<unsigned>(ints[t]) + static_cast<unsigned>(ints[t + half]));
  }
}

__global__ void meet_by_halves(int* ints);
__global__ void nans(int* ints, float nan);

}  // namespace jaywalk::test
