#pragma once
// An executor on a CUDA device: an order is one kernel, whose threads are a crew (crew_kernel.h). Stages work in the
// device's memory; what host and stages share lies in pinned host memory, and orders copy it at their begin and end. On
// a device that shares the host's memory all is in managed memory, which both cache, and nothing is copied.
#include <cuda_runtime.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <type_traits>
#include <vector>

#include "cuda/crew_kernel.h"
#include "planner/field/order.h"

namespace jaywalk {

/// How a kernel fits this device.
template <class Order>
struct Fit {
  int cluster_blocks = 0;  ///< of the largest cluster; 0: none
  int grid_blocks = 0;     ///< that run at a time
};

/// Why a device no longer serves.
enum class DeviceFailure : std::uint8_t {
  kNone,
  kRefused,  ///< a launch was refused; the next may not be
  kBroken,   ///< an error that stays as long as the process
  kSilent,   ///< a kernel has not ended in time, and may still run
};

class CudaExecutor {
 public:
  static constexpr bool kQueue = false;
  static constexpr bool kOneMemory = false;
  static constexpr std::int32_t kColumns = field::Crew<PlaceInGrid>::kColumns;
  static constexpr std::int32_t kCellsOfRow = field::Crew<PlaceInGrid>::kCellsOfRow;

  /// On the device of that number. An order that has not ended by `limit` has failed. Throws std::runtime_error with
  /// the driver's own words, or why the device does not do.
  CudaExecutor(int device, std::chrono::milliseconds limit) : device_(device), limit_(limit) {
    int cooperates = 0, integrated = 0, managed = 0, least = 0, greatest = 0;
    must(cudaSetDevice(device));
    must(cudaDeviceGetAttribute(&cooperates, cudaDevAttrCooperativeLaunch, device));
    must(cudaDeviceGetAttribute(&processors_, cudaDevAttrMultiProcessorCount, device));
    must(cudaDeviceGetAttribute(&integrated, cudaDevAttrIntegrated, device));
    must(cudaDeviceGetAttribute(&managed, cudaDevAttrManagedMemory, device));
    is_one_memory_ = integrated != 0 && managed != 0;
    if (cooperates == 0) throw std::runtime_error("the blocks of a kernel cannot meet on it");
    must(cudaDeviceGetStreamPriorityRange(&least, &greatest));
    must(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, greatest));
    must(cudaEventCreate(&begin_)), must(cudaEventCreate(&end_));
    std::apply([this](auto&... fit) { (look(fit), ...); }, fits_);
    notes_ = {take<field::Counted>(field::CrewNotes::kRoom), take<field::Counted>(field::CrewNotes::kTold)};
  }
  /// What a kernel may still be using is left behind: to free it would wait for the kernel.
  ~CudaExecutor() {
    if (failure_ == DeviceFailure::kSilent) (void)is_back();
    if (left_behind_) return;
    for (void* block : blocks_) cudaFree(block);
    for (void* block : shown_) cudaFreeHost(block);
    cudaEventDestroy(begin_), cudaEventDestroy(end_);
    cudaStreamDestroy(stream_);
  }
  CudaExecutor(const CudaExecutor&) = delete;
  CudaExecutor& operator=(const CudaExecutor&) = delete;

  template <class T>
  T* take(std::size_t n) {
    void* block = nullptr;
    must(is_one_memory_ ? cudaMallocManaged(&block, n * sizeof(T)) : cudaMalloc(&block, n * sizeof(T)));
    blocks_.push_back(block);
    must(cudaMemset(block, 0, n * sizeof(T)));
    must(cudaDeviceSynchronize());
    return static_cast<T*>(block);
  }

  /// The stages' own where host and device share their memory. Elsewhere pinned, zeroed, and at the same address for
  /// the device.
  template <class T>
  T* show(T* stages, std::size_t n) {
    if (is_one_memory_) return stages;
    void* block = nullptr;
    must(cudaHostAlloc(&block, n * sizeof(T), cudaHostAllocMapped | cudaHostAllocPortable));
    shown_.push_back(block);
    std::fill_n(static_cast<T*>(block), n, T{});
    return static_cast<T*>(block);
  }

  template <class T>
  void fill(T* to, const T* from, std::size_t n) {
    must(cudaMemcpy(to, from, n * sizeof(T), cudaMemcpyHostToDevice));
  }

  /// On a Jetson: one memory, which the host must not touch while a kernel runs.
  [[nodiscard]] bool is_one_memory() const noexcept { return is_one_memory_; }

  /// Of any order.
  [[nodiscard]] std::int32_t most_blocks() const noexcept {
    const Fit<field::SolveOrder>& fit = std::get<Fit<field::SolveOrder>>(fits_);
    return std::min(std::max(fit.cluster_blocks, fit.grid_blocks), field::kMostBlocks);
  }

  /// Whether memory may be touched and an order run: nothing that was given up still runs, and the device works.
  [[nodiscard]] bool is_ready() noexcept {
    return failure_ != DeviceFailure::kBroken && (failure_ != DeviceFailure::kSilent || is_back());
  }

  /// One launch. Sleeps until it has ended or its time is up; while an earlier one may still run, nothing is launched.
  template <class Order>
  bool run(const Order& order) noexcept {
    if (!is_ready()) return false;
    (void)cudaSetDevice(device_);  // each thread of the host has its own, at first device 0
    cudaEventRecord(begin_, stream_);
    const cudaError_t launched = launch(order);
    cudaEventRecord(end_, stream_);
    failure_ = launched == cudaSuccess ? waited() : DeviceFailure::kRefused;
    // Of errors that stay the second look still has one.
    if (cudaGetLastError() != cudaSuccess && cudaGetLastError() != cudaSuccess) failure_ = DeviceFailure::kBroken;
    float took_ms = 0.0F;
    if (failure_ != DeviceFailure::kNone || cudaEventElapsedTime(&took_ms, begin_, end_) != cudaSuccess) return false;
    took_ms_ += static_cast<double>(took_ms);
    return true;
  }

  /// Why the last order failed, in a few words; empty where it did not.
  [[nodiscard]] const char* failure() const noexcept {
    switch (failure_) {
      case DeviceFailure::kNone:
        return "";
      case DeviceFailure::kRefused:
        return "a launch was refused";
      case DeviceFailure::kBroken:
        return "the device failed";
      case DeviceFailure::kSilent:
        return "a kernel did not end in time";
    }
    return "";
  }

  /// What all orders together have taken on the device, by its own events.
  [[nodiscard]] double took_ms() const noexcept { return took_ms_; }
  [[nodiscard]] const char* name() const noexcept { return "cuda"; }
  /// Whether a kernel of this process may still run though all has been given up.
  [[nodiscard]] static bool has_left_behind() noexcept { return left_behind_; }

 private:
  /// Cells that a cluster's sixteen processors get through sooner than all of the device's would meet: 256 x 256. By
  /// reckoning, not measured.
  static constexpr std::int32_t kMostInCluster = 65536;

  /// Between two looks at the device: what a plan may come later, and no core is kept busy.
  static constexpr std::chrono::microseconds kLook{20};

  /// A host that was kept from its processor for a while looks so often before it gives the device up.
  static constexpr int kFewestLooks = 10;

  /// Until the last launch has ended, at most `limit_`.
  DeviceFailure waited() noexcept {
    const auto end = std::chrono::steady_clock::now() + limit_;
    for (int looks = 1;; ++looks) {
      const cudaError_t state = cudaEventQuery(end_);
      if (state == cudaSuccess) return DeviceFailure::kNone;
      if (state != cudaErrorNotReady) return DeviceFailure::kBroken;
      (void)cudaGetLastError();  // "not ready" is remembered as an error
      if (looks > kFewestLooks && std::chrono::steady_clock::now() > end)
        return left_behind_ = true, DeviceFailure::kSilent;
      std::this_thread::sleep_for(kLook);
    }
  }

  /// Whether what was silent has ended after all.
  [[nodiscard]] bool is_back() noexcept {
    const bool back = cudaEventQuery(end_) == cudaSuccess;
    (void)cudaGetLastError();
    if (back) left_behind_ = false;
    return back;
  }

  static void must(cudaError_t error) {
    if (error != cudaSuccess) throw std::runtime_error(cudaGetErrorString(error));
  }

  /// Of a block's own memory that an order needs.
  template <class Order>
  static constexpr std::size_t kBlockBytes = std::is_same_v<Order, field::SolveOrder> ? sizeof(field::StartTile) : 0;

  /// A launch with the one attribute that lets its blocks meet.
  struct Launch {
    cudaLaunchAttribute meets{};
    cudaLaunchConfig_t config{};

    Launch(int blocks, std::size_t block_bytes, cudaStream_t stream, bool in_cluster) {
      config.gridDim = dim3(static_cast<unsigned>(blocks));
      config.blockDim = dim3(kBlockThreads);
      config.dynamicSmemBytes = block_bytes;
      config.stream = stream;
      config.attrs = &meets;
      config.numAttrs = 1;
      if (in_cluster) {
        meets.id = cudaLaunchAttributeClusterDimension;
        meets.val.clusterDim = {static_cast<unsigned>(blocks), 1, 1};
      } else {
        meets.id = cudaLaunchAttributeCooperative;
        meets.val.cooperative = 1;
      }
    }
    Launch(const Launch&) = delete;
    Launch& operator=(const Launch&) = delete;
  };

  template <class Order>
  void look(Fit<Order>& fit) {
    int blocks_each = 0;
    must(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks_each, run_order<PlaceInGrid, Order>, kBlockThreads,
                                                       kBlockBytes<Order>));
    fit.grid_blocks = blocks_each * processors_;
    if (fit.grid_blocks == 0) throw std::runtime_error("a block needs more registers than it has");
    cudaFuncAttributes attributes{};
    const auto kernel = run_order<PlaceInCluster, Order>;
    must(cudaFuncGetAttributes(&attributes, kernel));
    if (attributes.ptxVersion < 90) return;  // compiled for an older device, whose blocks meet in grids alone
    const bool may_be_large =
        cudaFuncSetAttribute(kernel, cudaFuncAttributeNonPortableClusterSizeAllowed, 1) == cudaSuccess;
    for (int blocks = may_be_large ? 16 : 8; blocks >= 8 && fit.cluster_blocks == 0; blocks /= 2) {
      const Launch launch(blocks, kBlockBytes<Order>, stream_, true);
      int clusters = 0;
      if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &launch.config) == cudaSuccess && clusters > 0) {
        fit.cluster_blocks = blocks;
      }
    }
    (void)cudaGetLastError();  // a cluster that does not fit is no error
  }

  template <class Order>
  cudaError_t launch(const Order& order) noexcept {
    const Fit<Order>& fit = std::get<Fit<Order>>(fits_);
    int wanted = static_cast<int>((order.visits() + kBlockThreads - 1) / kBlockThreads);
    if constexpr (requires { order.most_blocks(); })
      wanted = std::min(wanted, std::min(order.most_blocks(), field::kMostBlocks));
    const bool in_cluster = fit.cluster_blocks > 0 && wanted > 1 && order.visits() <= kMostInCluster;
    const Launch with(in_cluster ? fit.cluster_blocks : std::min(wanted, fit.grid_blocks), kBlockBytes<Order>, stream_,
                      in_cluster);
    return in_cluster ? cudaLaunchKernelEx(&with.config, run_order<PlaceInCluster, Order>, order, notes_)
                      : cudaLaunchKernelEx(&with.config, run_order<PlaceInGrid, Order>, order, notes_);
  }

  static inline std::atomic<bool> left_behind_{false};

  int device_;
  std::chrono::milliseconds limit_;
  DeviceFailure failure_ = DeviceFailure::kNone;
  bool is_one_memory_ = false;
  int processors_ = 0;
  cudaStream_t stream_ = nullptr;
  cudaEvent_t begin_ = nullptr, end_ = nullptr;
  std::tuple<Fit<field::MarkAndClearOrder>, Fit<field::ClearOrder>, Fit<field::SolveOrder>, Fit<field::PullOrder>>
      fits_;
  std::vector<void*> blocks_, shown_;
  field::CrewNotes notes_{};
  double took_ms_ = 0.0;
};

}  // namespace jaywalk
