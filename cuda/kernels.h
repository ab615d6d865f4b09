#pragma once
// The kernels that stages run in: one stage, a thread a visit; or a whole order of small steps, in one block.
#include <cuda_runtime.h>

#include <cstdint>

#include "planner/field/executor.h"

/// Before a loop: the compiler does not unroll it. Unrolled, the kernel's code would not fit the instruction cache.
#ifdef __CUDACC__
#define JAYWALK_ROLLED _Pragma("unroll 1")
#else
#define JAYWALK_ROLLED
#endif

namespace jaywalk {

inline constexpr int kVisitThreads = 256;  ///< of a block: enough of them for any processor, few enough to spread
inline constexpr int kBlockThreads =
    512;  ///< of the one that takes an order alone: as many as a thread's registers allow

/// Visit k of many, in rows of `width`, a power of two: a stage of cells is told column and row, another one k.
template <class Stage>
__device__ void visit_one(const Stage& stage, std::int32_t k, std::int32_t width) {
  if constexpr (requires { stage(k, k); }) {
    stage(k & (width - 1), k >> (31 - __clz(width)));
  } else {
    stage(k);
  }
}

template <class Stage>
__global__ void __launch_bounds__(kVisitThreads)
    visit(const __grid_constant__ Stage stage, std::int32_t width, std::int32_t n) {
  const auto k = static_cast<std::int32_t>(blockIdx.x * kVisitThreads + threadIdx.x);
  if (k < n) visit_one(stage, k, width);
}

/// An executor inside a kernel: one block's threads share every step, and meet where it ends.
struct BlockLoops {
  static constexpr bool kInTurn = false, kLowerLevels = true;
  static constexpr std::int32_t kCellsOfRow = 16, kOneBlockSide = 0;

  template <class Stage>
  __device__ void for_each(std::int32_t n, const Stage& stage) const {
    for_each_cell(n, 1, stage);
  }
  template <class Stage>
  __device__ void for_each_cell(std::int32_t width, std::int32_t height, const Stage& stage) const {
    JAYWALK_ROLLED
    for (auto k = static_cast<std::int32_t>(threadIdx.x); k < width * height; k += kBlockThreads)
      visit_one(stage, k, width);
    __syncthreads();
  }
  template <class... Steps>
  __device__ void for_each_row(std::int32_t height, const Steps&... steps) const {
    (for_each_cell(steps.width, height / steps.every, steps.stage), ...);
  }
  template <class... Steps>
  __device__ void repeat(std::int32_t n, std::int32_t height, const Steps&... steps) const {
    JAYWALK_ROLLED
    for (std::int32_t k = 0; k < n; ++k) for_each_row(height, steps...);
  }
  [[nodiscard]] __device__ field::Counted total(std::int32_t n, const field::Counted* counted) const {
    field::Counted sum;
    JAYWALK_ROLLED
    for (std::int32_t k = 0; k < n; ++k) sum.cells += counted[k].cells, sum.joined += counted[k].joined;
    return sum;
  }
  template <class Order>
  __device__ void in_one_block(const Order& order) const {
    order(*this);
  }
};

template <class Order>
__global__ void __launch_bounds__(kBlockThreads, 1) run_in_one_block(const __grid_constant__ Order order) {
  const BlockLoops loops;
  order(loops);
}

}  // namespace jaywalk
