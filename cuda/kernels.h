#pragma once
// The kernel that a stage runs in: a thread a visit.
#include <cuda_runtime.h>

#include <cstdint>

namespace jaywalk {

inline constexpr int kVisitThreads = 256;  ///< of a block: enough of them for any processor, few enough to spread

/// Visit k of `n`, in rows of `width`, a power of two: a stage of cells is told column and row, another one k.
template <class Stage>
__global__ void __launch_bounds__(kVisitThreads)
    visit(const __grid_constant__ Stage stage, std::int32_t width, std::int32_t n) {
  const auto k = static_cast<std::int32_t>(blockIdx.x * kVisitThreads + threadIdx.x);
  if (k >= n) return;
  if constexpr (requires { stage(k, k); }) {
    stage(k & (width - 1), k >> (31 - __clz(width)));
  } else {
    stage(k);
  }
}

}  // namespace jaywalk
