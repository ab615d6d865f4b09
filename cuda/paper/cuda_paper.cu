#include <utility>

#include "cuda/cuda_device.h"
#include "cuda/paper/cuda_paper.h"
#include "planner/paper/executor.h"
#include "planner/paper/paper_planner.h"

namespace jaywalk::paper {
namespace {

constexpr int kSumThreads = 512;

/// Sum of the rows' counts, by one block.
__global__ void __launch_bounds__(kSumThreads) add_up(const Counted* counted, std::int32_t n, Counted* sum) {
  __shared__ std::int32_t cells, joined;
  if (threadIdx.x == 0) cells = joined = 0;
  __syncthreads();
  Counted mine;
  for (auto k = static_cast<std::int32_t>(threadIdx.x); k < n; k += kSumThreads)
    mine.cells += counted[k].cells, mine.joined += counted[k].joined;
  atomicAdd(&cells, mine.cells), atomicAdd(&joined, mine.joined);
  __syncthreads();
  if (threadIdx.x == 0) *sum = {cells, joined};
}

/// An executor on a CUDA device: every stage is a launch on one stream.
class CudaExecutor {
 public:
  /// `limit`: longest wait for the device, as CudaDevice has it.
  CudaExecutor(int device, std::chrono::milliseconds limit) : device_(device, limit), sum_(device_.share<Counted>(1)) {}

  template <class T>
  T* take(std::size_t n) {
    return device_.take<T>(n);
  }
  template <class T>
  T* show(T*, std::size_t n) {
    return device_.pin<T>(n);
  }
  [[nodiscard]] bool is_ready() noexcept { return device_.is_ready(); }
  [[nodiscard]] bool begin() noexcept { return device_.begin(); }
  [[nodiscard]] bool end() noexcept { return device_.wait(); }
  [[nodiscard]] const char* failure() const noexcept { return device_.failure(); }
  [[nodiscard]] double took_ms() const noexcept { return device_.took_ms(); }
  [[nodiscard]] static const char* name() noexcept { return "cuda"; }

  template <class T>
  void copy(std::int32_t n, const T* from, T* to) noexcept {
    device_.copy(to, from, static_cast<std::size_t>(n));
  }
  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) noexcept {
    if (w * h > 0) device_.launch_visits(stage, w, w * h);
  }
  /// Zeros where the device has failed: the caller then finds no way, and stops.
  [[nodiscard]] Counted total(std::int32_t n, const Counted* counted) noexcept {
    device_.launch(add_up, 1, kSumThreads, counted, n, sum_.device);
    device_.copy_out(sum_, 1);
    return device_.wait() && device_.begin() ? *sum_.host : Counted{};
  }

 private:
  CudaDevice device_;
  Shared<Counted> sum_;
};

constexpr std::chrono::seconds kLongestField{30};  ///< of a map of 4096 cells a side, on the slowest device

}  // namespace

std::unique_ptr<Planner> make_cuda_paper_planner(const PaperConfig& config, int device, std::string& why_not,
                                                 std::chrono::milliseconds limit) {
  check(config);
  return on_device(device, why_not, [&] {
    return std::make_unique<PaperPlanner<CudaExecutor>>(config, std::make_unique<CudaExecutor>(device, limit));
  });
}

std::unique_ptr<MapField> make_cuda_map_field(CellMap map, int device, std::string& why_not) {
  return on_device(device, why_not, [&] {
    return std::make_unique<MapFieldOn<CudaExecutor>>(std::move(map),
                                                      std::make_unique<CudaExecutor>(device, kLongestField));
  });
}

}  // namespace jaywalk::paper
