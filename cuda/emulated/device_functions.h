#pragma once
// What kernels themselves say: CUDA's words, places, barriers, warps and atomics.
#include <bit>
#include <cstdint>
#include <cstring>

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
inline void __syncwarp(unsigned = 0xffffffffU) { jaywalk::emulated::launch_under_way->meet_warp(); }
inline void __threadfence() {}
inline void __threadfence_block() {}
/// A thread that waits for what another writes must call it: nothing else lets the other run.
inline void __nanosleep(unsigned) { jaywalk::emulated::launch_under_way->pause(); }

inline int __clz(int n) { return std::countl_zero(static_cast<unsigned>(n)); }
inline int __ffs(int n) { return n == 0 ? 0 : std::countr_zero(static_cast<unsigned>(n)) + 1; }
inline int __popc(unsigned n) { return std::popcount(n); }

namespace jaywalk::emulated {

/// What each lane hands to `choose`'s lane. All lanes of the warp must take part.
template <class T>
T shuffled(T value, std::size_t from) {
  static_assert(sizeof(T) <= sizeof(std::uint64_t));
  Launch& launch = *launch_under_way;
  const std::size_t lane = launch.thread() % Launch::kWarp;
  std::memcpy(&launch.lane_value(lane), &value, sizeof value);
  launch.meet_warp();
  if (from < Launch::kWarp) std::memcpy(&value, &launch.lane_value(from), sizeof value);
  launch.meet_warp();
  return value;
}
inline std::size_t lane() { return launch_under_way->thread() % Launch::kWarp; }

}  // namespace jaywalk::emulated

template <class T>
T __shfl_sync(unsigned, T value, int from) {
  return jaywalk::emulated::shuffled(value, static_cast<std::size_t>(from) % 32);
}
template <class T>
T __shfl_up_sync(unsigned, T value, unsigned by) {
  const std::size_t lane = jaywalk::emulated::lane();
  return jaywalk::emulated::shuffled(value, lane < by ? lane : lane - by);
}
template <class T>
T __shfl_down_sync(unsigned, T value, unsigned by) {
  const std::size_t lane = jaywalk::emulated::lane();
  return jaywalk::emulated::shuffled(value, lane + by > 31 ? lane : lane + by);
}
template <class T>
T __shfl_xor_sync(unsigned, T value, int mask) {
  return jaywalk::emulated::shuffled(value, jaywalk::emulated::lane() ^ static_cast<std::size_t>(mask));
}
inline unsigned __ballot_sync(unsigned mask, bool vote) {
  unsigned votes = vote ? 1U << jaywalk::emulated::lane() : 0U;
  for (int by = 1; by < 32; by *= 2) votes |= __shfl_xor_sync(mask, votes, by);
  return votes;
}
inline bool __any_sync(unsigned mask, bool vote) { return __ballot_sync(mask, vote) != 0; }
inline bool __all_sync(unsigned mask, bool vote) { return __ballot_sync(mask, !vote) == 0; }

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
T atomicMin(T* at, T with) {
  return jaywalk_changed(at, [with](T x) { return with < x ? with : x; });
}
template <class T>
T atomicMax(T* at, T with) {
  return jaywalk_changed(at, [with](T x) { return x < with ? with : x; });
}
template <class T>
T atomicOr(T* at, T with) {
  return jaywalk_changed(at, [with](T x) { return static_cast<T>(x | with); });
}
template <class T>
T atomicExch(T* at, T with) {
  return jaywalk_changed(at, [with](T) { return with; });
}
template <class T>
T atomicCAS(T* at, T expected, T with) {
  return jaywalk_changed(at, [expected, with](T x) { return x == expected ? with : x; });
}
