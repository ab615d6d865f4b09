#include <cmath>
#include <cstring>

#include "tests/cuda/sample_kernels.h"

namespace jaywalk::test {

__global__ void add_place(int* ints) {
  const unsigned k = blockIdx.x * blockDim.x + threadIdx.x;
  ints[k] = static_cast<int>(k);
}

__global__ void meet_by_halves(int*) {
  if (threadIdx.x % 2 == 0) __syncthreads();
}

__global__ void nans(int* ints, float nan) {
  const float zero = nan == nan ? 1.0F : 0.0F, infinity = 1.0F / zero;  // what the compiler cannot know
  const float values[] = {nan, nan + 1.0F, zero / zero, infinity - infinity, zero + 1.5F, std::sqrt(zero - 1.0F)};
  std::memcpy(ints, values, sizeof values);
}

}  // namespace jaywalk::test
