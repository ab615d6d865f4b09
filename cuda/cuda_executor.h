#pragma once
// An executor on a CUDA device: every stage is a launch on one stream. The host waits where its next step depends
// on a count, and at the end.
#include <memory>

#include "cuda/cuda_cost_to_go.h"
#include "cuda/kernels.h"
#include "cuda/start_ways.h"
#include "planner/field/field_arrays.h"

namespace jaywalk {

/// By one block: what stages have counted, in all.
static __global__ void __launch_bounds__(kBlockThreads)
    add_up(const field::Counted* counted, std::int32_t n, field::Counted* sum) {
  __shared__ std::int32_t cells, joined;
  if (threadIdx.x == 0) cells = joined = 0;
  __syncthreads();
  field::Counted mine;
  for (auto k = static_cast<std::int32_t>(threadIdx.x); k < n; k += kBlockThreads)
    mine.cells += counted[k].cells, mine.joined += counted[k].joined;
  atomicAdd(&cells, mine.cells), atomicAdd(&joined, mine.joined);
  __syncthreads();
  if (threadIdx.x == 0) *sum = {cells, joined};
}

class CudaExecutor {
 public:
  static constexpr bool kQueue = false;
  static constexpr bool kInTurn = false;
  static constexpr std::int32_t kCellsOfRow = 16;
  /// By reckoning, not measured: a launch takes as long as one block takes for four thousand cells.
  static constexpr std::int32_t kOneBlockSide = 64;
  static constexpr bool kLowerLevels = false;

  /// As CudaDevice.
  CudaExecutor(int device, std::chrono::milliseconds limit)
      : device_(device, limit),
        waits_(device_.share<std::int32_t>(kMostTiles)),
        sum_(device_.share<field::Counted>(1)) {}

  template <class T>
  T* take(std::size_t n) {
    return device_.take<T>(n);
  }
  /// The stages' own where host and device share their memory.
  template <class T>
  T* show(T* stages, std::size_t n) {
    return device_.is_one_memory() ? stages : device_.pin<T>(n);
  }
  template <class T>
  void fill(T* to, const T* from, std::size_t n) {
    device_.fill(to, from, n);
  }
  /// The time to go over poses and in windows of up to `max_side` cells, on this device too.
  void take_cost_to_go(std::int32_t max_side) { cost_to_go_ = std::make_unique<CudaCostToGo>(device_, max_side); }
  [[nodiscard]] field::CostSettler* settler() noexcept { return cost_to_go_.get(); }

  [[nodiscard]] bool is_one_memory() const noexcept { return device_.is_one_memory(); }
  [[nodiscard]] bool is_ready() noexcept { return device_.is_ready(); }
  [[nodiscard]] bool has_failed() const noexcept { return device_.has_failed(); }
  [[nodiscard]] const char* failure() const noexcept { return device_.failure(); }
  [[nodiscard]] double took_ms() const noexcept { return device_.took_ms(); }
  [[nodiscard]] const char* name() const noexcept { return "cuda"; }

  [[nodiscard]] bool begin() noexcept { return device_.begin(); }
  [[nodiscard]] bool end() noexcept { return device_.wait(); }
  template <class T>
  void copy(std::int32_t n, const T* from, T* to) noexcept {
    device_.copy(to, from, static_cast<std::size_t>(n));
  }
  template <class Stage>
  void for_each(std::int32_t n, const Stage& stage) noexcept {
    for_each_cell(n, 1, stage);
  }
  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) noexcept {
    const std::int32_t n = w * h;
    if (n > 0) device_.launch(visit<Stage>, (n + kVisitThreads - 1) / kVisitThreads, kVisitThreads, stage, w, n);
  }
  template <class... Steps>
  void for_each_row(std::int32_t h, const Steps&... steps) noexcept {
    (for_each_cell(steps.width, h / steps.every, steps.stage), ...);
  }
  template <class... Steps>
  void repeat(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    for (std::int32_t k = 0; k < n; ++k) for_each_row(h, steps...);
  }
  template <class Order>
  void in_one_block(const Order& order) noexcept {
    device_.launch(run_in_one_block<Order>, 1, kBlockThreads, order);
  }
  /// Zeros where the device has failed: the caller then finds no way, and stops.
  [[nodiscard]] field::Counted total(std::int32_t n, const field::Counted* counted) noexcept {
    device_.launch(add_up, 1, kBlockThreads, counted, n, sum_.device);
    device_.copy_out(sum_, 1);
    return device_.wait() && device_.begin() ? *sum_.host : field::Counted{};
  }
  /// The start field's costs, by tiles.
  void settle(field::Grid grid, std::int32_t goal, const field::FieldArrays& a) noexcept {
    for_each(grid.cells(), FarFromGoal{goal, a.cost});
    (void)settle_tiles(device_, StartWays{grid, a.rate, a.cost}, waits_);
  }

 private:
  static constexpr std::size_t kMostTiles = 128 * 128;  ///< of grids of 4096 cells a side

  CudaDevice device_;
  Shared<std::int32_t> waits_;
  Shared<field::Counted> sum_;
  std::unique_ptr<CudaCostToGo> cost_to_go_;
};

}  // namespace jaywalk
