#include <utility>

#include "cuda/on_device.h"
#include "cuda/paper/cuda_executor.h"
#include "cuda/paper/cuda_paper.h"
#include "planner/paper/map_field_on.h"
#include "planner/paper/paper_planner.h"

namespace jaywalk::paper {
namespace {

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
