#pragma once
// A CUDA device as the planner has it: one stream, memory that is taken at the start, and a wait that ends. Shared
// arrays lie twice, in pinned and in the device's memory: on a Jetson managed memory is maintained at every launch.
#include <cuda_runtime.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

namespace jaywalk {

/// Why a device no longer serves.
enum class DeviceFailure : std::uint8_t {
  kNone,
  kRefused,  ///< a launch was refused; the next may not be
  kBroken,   ///< an error that stays as long as the process
  kSilent,   ///< a kernel has not ended in time, and may still run
};

/// One array for both sides.
template <class T>
struct Shared {
  T* host = nullptr;
  T* device = nullptr;
};

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

class CudaDevice {
 public:
  /// What has not ended by `limit` has failed. Throws std::runtime_error with the driver's own words.
  CudaDevice(int device, std::chrono::milliseconds limit);
  /// What a kernel may still be using is left behind: to free it would wait for the kernel.
  ~CudaDevice();
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;

  /// Memory for kernels alone, zeroed. Throws as the constructor does.
  template <class T>
  T* take(std::size_t n) {
    return static_cast<T*>(take_bytes(n * sizeof(T)));
  }
  /// The host's, zeroed, which the device copies from and to.
  template <class T>
  T* pin(std::size_t n) {
    return static_cast<T*>(pin_bytes(n * sizeof(T)));
  }
  template <class T>
  Shared<T> share(std::size_t n) {
    return {pin<T>(n), take<T>(n)};
  }
  /// Whether shared memory may be touched and kernels launched: the device works, and nothing given up still runs.
  [[nodiscard]] bool is_ready() noexcept {
    if (failure_ == DeviceFailure::kRefused || (failure_ == DeviceFailure::kSilent && is_back()))
      failure_ = DeviceFailure::kNone;
    return !has_failed();
  }
  /// Since it was ready last.
  [[nodiscard]] bool has_failed() const noexcept { return failure_ != DeviceFailure::kNone; }

  /// What is launched and copied from now on, up to the wait that ends it. False while an earlier kernel may still run.
  [[nodiscard]] bool begin() noexcept;
  /// Between the two places of what is shared.
  template <class T>
  void copy(T* to, const T* from, std::size_t n) noexcept {
    if (launched_ == cudaSuccess) launched_ = cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDefault, stream_);
  }
  /// Each byte of n values.
  template <class T>
  void set_bytes(T* to, int byte, std::size_t n) noexcept {
    if (launched_ == cudaSuccess) launched_ = cudaMemsetAsync(to, byte, n * sizeof(T), stream_);
  }
  template <class T>
  void copy_in(const Shared<T>& a, std::size_t n) noexcept {
    copy(a.device, a.host, n);
  }
  template <class T>
  void copy_out(const Shared<T>& a, std::size_t n) noexcept {
    copy(a.host, a.device, n);
  }
  template <class... Parameters, class... Arguments>
  void launch(void (*kernel)(Parameters...), int blocks, int threads, const Arguments&... arguments) noexcept {
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(static_cast<unsigned>(blocks)), config.blockDim = dim3(static_cast<unsigned>(threads));
    config.stream = stream_;
    if (launched_ == cudaSuccess) launched_ = cudaLaunchKernelEx(&config, kernel, arguments...);
  }
  /// A stage, a thread a visit, as visit() has them.
  template <class Stage>
  void launch_visits(const Stage& stage, std::int32_t width, std::int32_t n) noexcept {
    launch(visit<Stage>, (n + kVisitThreads - 1) / kVisitThreads, kVisitThreads, stage, width, n);
  }
  /// Waits until all since begin() has ended or its time is up. False: it failed; nothing more runs until begin().
  [[nodiscard]] bool wait() noexcept;

  /// Why the last wait failed, in a few words; empty where it did not.
  [[nodiscard]] const char* failure() const noexcept;
  /// What all that was launched has taken on the device, by its own events.
  [[nodiscard]] double took_ms() const noexcept { return took_ms_; }
  /// Whether a kernel of this process may still run though all has been given up.
  [[nodiscard]] static bool has_left_behind() noexcept { return left_behind_; }

 private:
  void* take_bytes(std::size_t bytes);
  void* pin_bytes(std::size_t bytes);
  [[nodiscard]] DeviceFailure waited() noexcept;
  [[nodiscard]] bool is_back() noexcept;

  static inline std::atomic<bool> left_behind_{false};

  int device_;
  std::chrono::milliseconds limit_;
  DeviceFailure failure_ = DeviceFailure::kNone;
  cudaError_t launched_ = cudaSuccess;
  cudaStream_t stream_ = nullptr;
  cudaEvent_t begin_ = nullptr, end_ = nullptr;
  std::vector<void*> taken_, pinned_;
  double took_ms_ = 0.0;
};

/// Returns make()'s result on a device. Null, and the reason in `why_not`, without such a device or where it fails.
template <class Make>
auto on_device(int device, std::string& why_not, const Make& make) -> decltype(make()) {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess || devices == 0) {
    why_not = std::string("cuda: no device (") + cudaGetErrorString(found) + ")";
    return nullptr;
  }
  if (device >= devices) {
    why_not = "cuda: no device " + std::to_string(device) + " (" + std::to_string(devices) + " there, numbered from 0)";
    return nullptr;
  }
  try {
    return make();
  } catch (const std::exception& error) {
    why_not = std::string("cuda: the device does not serve (") + error.what() + ")";
    return nullptr;
  }
}

}  // namespace jaywalk
