#pragma once
// Costs that only fall, settled tile by tile in launches until no tile waits: label-correcting, so that the result is
// one fixed point whatever the order. A tile waits where a neighbour has changed what its cells step from.
//
// Ways says what the cells and the steps are:
//   Value, kNone                  of a cost; none
//   kTile, kLayers, kThreads      cells a side of a tile, cells upon one another, threads of a block
//   kReach                        cells that a step spans at most
//   side()                        of the grid, cells: a multiple of kTile
//   cost                          of all cells
//   holds(i, j), at(i, j, layer)  whether there is such a cell, and its place in `cost`
//   limit()                       what costs more is not stepped from; falls as costs do, and may be read while they do
//   least(i, j, layer, own, limit, near)
//                                 what a cell costs by its neighbours, `own` at most; near(di, dj, layer) is their cost
#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cuda/cuda_device.h"

namespace jaywalk {

/// Past a processor's own cache, which does not see what others write.
template <class T>
__device__ T peek(const T* at) {
  return *static_cast<const volatile T*>(at);
}
template <class T>
__device__ void put(T* at, T value) {
  *static_cast<volatile T*>(at) = value;
}

/// Bits of the neighbours that step from a cell of a tile at (i, j): bit 3 (dj + 1) + di + 1 for the tile (di, dj)
/// beside it. A step reaches half a tile at most.
__device__ inline int tiles_that_see(int i, int j, int tile, int reach) {
  const int di = i < reach ? -1 : (i >= tile - reach ? 1 : 0), dj = j < reach ? -1 : (j >= tile - reach ? 1 : 0);
  return (di != 0 ? 1 << (4 + di) : 0) | (dj != 0 ? 1 << (4 + 3 * dj) : 0) |
         (di != 0 && dj != 0 ? 1 << (4 + 3 * dj + di) : 0);
}

/// A block a tile.
template <class Ways>
__global__ void __launch_bounds__(Ways::kThreads) settle_tile(const __grid_constant__ Ways ways, std::int32_t* waits) {
  using Value = typename Ways::Value;
  constexpr int kTile = Ways::kTile, kReach = Ways::kReach, kWide = kTile + 2 * kReach;
  constexpr int kThreads = Ways::kThreads, kEach = kTile * kTile * Ways::kLayers / kThreads;
  static_assert(kEach * kThreads == kTile * kTile * Ways::kLayers && 2 * kReach <= kTile);
  __shared__ Value cost[kWide * kWide * Ways::kLayers];
  __shared__ int changed;
  const int me = static_cast<int>(threadIdx.x), tile = static_cast<int>(blockIdx.x), tiles = ways.side() / kTile;
  const int i0 = tile % tiles * kTile, j0 = tile / tiles * kTile;
  const auto place = [](int i, int j, int layer) { return (layer * kWide + j + kReach) * kWide + i + kReach; };
  const bool waited = me == 0 && atomicExch(waits + tile, 0) != 0;
  if (me == 0) changed = 0;
  if (__syncthreads_or(waited ? 1 : 0) == 0) return;
  __threadfence();
  bool any = false;
  for (int k = me; k < kWide * kWide * Ways::kLayers; k += kThreads) {
    const int i = i0 + k % kWide - kReach, j = j0 + k / kWide % kWide - kReach;
    cost[k] = ways.holds(i, j) ? peek(ways.cost + ways.at(i, j, k / (kWide * kWide))) : Ways::kNone;
    any |= cost[k] != Ways::kNone;
  }
  const std::uint32_t limit = ways.limit();
  Value next[static_cast<std::size_t>(kEach)];
  for (bool falls = any; __syncthreads_or(falls ? 1 : 0) != 0;) {
    for (int e = 0; e < kEach; ++e) {
      const int k = me + e * kThreads, i = k % kTile, j = k / kTile % kTile, layer = k / (kTile * kTile);
      const auto near = [&](int di, int dj, int at) -> std::uint32_t { return cost[place(i + di, j + dj, at)]; };
      next[e] = static_cast<Value>(ways.least(i0 + i, j0 + j, layer, cost[place(i, j, layer)], limit, near));
    }
    __syncthreads();  // a cost that fell meanwhile would do no harm; a race it would be
    falls = false;
    for (int e = 0; e < kEach; ++e) {
      const int k = me + e * kThreads, at = place(k % kTile, k / kTile % kTile, k / (kTile * kTile));
      falls |= next[e] < cost[at];
      cost[at] = next[e];
    }
  }
  int seen = 0;
  for (int e = 0; e < kEach; ++e) {
    const int k = me + e * kThreads, i = k % kTile, j = k / kTile % kTile, layer = k / (kTile * kTile);
    Value* const kept = ways.cost + ways.at(i0 + i, j0 + j, layer);
    const Value now = cost[place(i, j, layer)];
    if (now == peek(kept)) continue;
    put(kept, now);
    seen |= tiles_that_see(i, j, kTile, kReach);
  }
  if (seen != 0) atomicOr(&changed, seen);
  __threadfence();
  __syncthreads();
  const int di = me % 3 - 1, dj = me / 3 - 1, ti = tile % tiles + di, tj = tile / tiles + dj;
  if (me < 9 && (changed & 1 << me) != 0 && ti >= 0 && tj >= 0 && ti < tiles && tj < tiles)
    atomicExch(waits + tj * tiles + ti, 1);
}

/// From given costs to the fixed point; all tiles wait at first. Launches go in rounds, between which the host looks
/// whether any tile still waits. It follows what has been launched since device.begin(), and more may follow it. False:
/// the device failed.
template <class Ways>
[[nodiscard]] bool settle_tiles(CudaDevice& device, const Ways& ways, const Shared<std::int32_t>& waits) noexcept {
  constexpr int kRounds = 8;
  const int tiles = (ways.side() / Ways::kTile) * (ways.side() / Ways::kTile);
  device.set_bytes(waits.device, 1, static_cast<std::size_t>(tiles));
  for (;;) {
    for (int round = 0; round < kRounds; ++round)
      device.launch(settle_tile<Ways>, tiles, Ways::kThreads, ways, waits.device);
    device.copy_out(waits, static_cast<std::size_t>(tiles));
    if (!device.wait() || !device.begin()) return false;
    if (std::all_of(waits.host, waits.host + tiles, [](std::int32_t w) { return w == 0; })) return true;
  }
}

}  // namespace jaywalk
