#pragma once
// An executor on a CUDA device: one kernel that calls a stage, in one and two dimensions. Memory is
// managed, so that the host reads results and writes requests without copies (after wait()).
#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "planner/field/executor.h"

namespace jaywalk {

template <class Stage>
__global__ void visit(std::int32_t n, Stage stage) {
  const auto k = static_cast<std::int32_t>(blockIdx.x * blockDim.x + threadIdx.x);
  if (k < n) stage(k);
}

template <class Stage>
__global__ void visit_cells(std::int32_t w, std::int32_t h, Stage stage) {
  const auto i = static_cast<std::int32_t>(blockIdx.x * blockDim.x + threadIdx.x);
  const auto j = static_cast<std::int32_t>(blockIdx.y * blockDim.y + threadIdx.y);
  if (i < w && j < h) stage(i, j);
}

/// Threads of the one block that small boards get; registers are shared out among as many.
inline constexpr int kBlockThreads = 1024;

/// All visits of one step by the threads of one block; the next step sees what it has written.
template <class Step>
__device__ void visit_in_block(std::int32_t h, const Step& step) {
  const std::int32_t visits = step.width * (h / step.every);
  for (auto k = static_cast<std::int32_t>(threadIdx.x); k < visits; k += static_cast<std::int32_t>(blockDim.x)) {
    step.stage(k % step.width, k / step.width);
  }
  __syncthreads();
}

/// The steps in order, `n` times over, in one block: for boards so small that launching takes longer than visiting.
template <class... Steps>
__global__ void __launch_bounds__(kBlockThreads) repeat_in_block(std::int32_t n, std::int32_t h, Steps... steps) {
  for (std::int32_t k = 0; k < n; ++k) (visit_in_block(h, steps), ...);
}

class CudaExecutor {
 public:
  static constexpr bool kQueue = false;
  static constexpr bool kOneMemory = true;
  static constexpr std::int32_t kColumns = 1;
  static constexpr std::int32_t kCellsOfRow = 16;

  /// Throws std::runtime_error with the driver's own words.
  CudaExecutor() { must(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking)); }
  ~CudaExecutor() {
    for (void* block : blocks_) cudaFree(block);
    cudaStreamDestroy(stream_);
  }
  CudaExecutor(const CudaExecutor&) = delete;
  CudaExecutor& operator=(const CudaExecutor&) = delete;

  template <class T>
  T* take(std::size_t n) {
    void* block = nullptr;
    must(cudaMallocManaged(&block, n * sizeof(T)));
    blocks_.push_back(block);
    must(cudaMemset(block, 0, n * sizeof(T)));
    must(cudaDeviceSynchronize());
    return static_cast<T*>(block);
  }
  template <class T>
  T* show(T* stages, std::size_t) {
    return stages;
  }
  template <class T>
  void fill(T* to, const T* from, std::size_t n) {
    must(cudaMemcpy(to, from, n * sizeof(T), cudaMemcpyDefault));
  }
  template <class Order>
  bool run(const Order& order) noexcept {
    order(*this);
    return wait();
  }

  template <class Stage>
  void for_each(std::int32_t n, const Stage& stage) noexcept {
    constexpr std::int32_t kThreads = 128;
    if (n > 0) visit<<<blocks(n, kThreads), kThreads, 0, stream_>>>(n, stage);
  }

  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) noexcept {
    const dim3 threads(32, 4);
    const dim3 grid(blocks(w, 32), blocks(h, 4));
    if (w > 0 && h > 0) visit_cells<<<grid, threads, 0, stream_>>>(w, h, stage);
  }

  template <class... Steps>
  void for_each_row(std::int32_t h, const Steps&... steps) noexcept {
    repeat(1, h, steps...);
  }

  template <class... Steps>
  void repeat(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    constexpr std::int32_t kMostInBlock = 8192;  ///< visits of a step: eight of each thread
    if (((h * steps.width <= kMostInBlock) && ...)) {
      if (n > 0) repeat_in_block<<<1, kBlockThreads, 0, stream_>>>(n, h, steps...);
      return;
    }
    for (std::int32_t k = 0; k < n; ++k) (for_each_cell(steps.width, h / steps.every, steps.stage), ...);
  }

  /// None where the device has failed, so that the order comes to its end.
  field::Counted total(std::int32_t n, const field::Counted* counted) noexcept {
    return wait() ? field::SerialExecutor::total(n, counted) : field::Counted{};
  }

  [[nodiscard]] const char* name() const noexcept { return "cuda"; }

 private:
  bool wait() noexcept { return cudaStreamSynchronize(stream_) == cudaSuccess && cudaGetLastError() == cudaSuccess; }
  static unsigned blocks(std::int32_t n, std::int32_t threads) {
    return static_cast<unsigned>((n + threads - 1) / threads);
  }
  static void must(cudaError_t error) {
    if (error != cudaSuccess) throw std::runtime_error(cudaGetErrorString(error));
  }

  cudaStream_t stream_ = nullptr;
  std::vector<void*> blocks_;
};

}  // namespace jaywalk
