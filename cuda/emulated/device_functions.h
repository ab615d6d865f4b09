#pragma once
// What kernels themselves say: CUDA's words, places, barriers and atomics.
#include <bit>
#include <cstdint>

#include "cuda/emulated/device.h"

#define __global__
#define __device__
#define __host__
#define __forceinline__ inline
#define __constant__
#define __grid_constant__
#define __launch_bounds__(...)
#define __shared__ thread_local
#define __CUDA_ARCH__ 900

struct dim3 {
  unsigned x, y, z;
  constexpr dim3(unsigned of_x = 1, unsigned of_y = 1, unsigned of_z = 1) : x(of_x), y(of_y), z(of_z) {}
};

inline const jaywalk::emulated::Extent& threadIdx = jaywalk::emulated::here.thread;
inline const jaywalk::emulated::Extent& blockIdx = jaywalk::emulated::here.block;
inline const jaywalk::emulated::Extent& blockDim = jaywalk::emulated::here.block_extent;
inline const jaywalk::emulated::Extent& gridDim = jaywalk::emulated::here.grid_extent;

inline void __syncthreads() { jaywalk::emulated::launch_under_way->meet_block(); }
inline int __syncthreads_or(int vote) { return jaywalk::emulated::launch_under_way->any_of_block(vote != 0) ? 1 : 0; }
inline void __threadfence() {}
inline void __threadfence_block() {}
inline int __clz(int n) { return std::countl_zero(static_cast<unsigned>(n)); }
inline int __ffs(int n) { return n == 0 ? 0 : std::countr_zero(static_cast<unsigned>(n)) + 1; }

// Fibers give way at barriers alone, so plain code is atomic.
template <class T, class Change>
T jaywalk_changed(T* at, Change change) {
  const T before = *at;
  *at = change(before);
  return before;
}
template <class T>
T atomicAdd(T* at, T by) {
  return jaywalk_changed(at, [by](T x) { return static_cast<T>(x + by); });
}
template <class T>
T atomicOr(T* at, T with) {
  return jaywalk_changed(at, [with](T x) { return static_cast<T>(x | with); });
}
template <class T>
T atomicExch(T* at, T with) {
  return jaywalk_changed(at, [with](T) { return with; });
}
