#include "cuda/cuda_executor.h"
#include "cuda/cuda_planner.h"
#include "planner/field/grid_planner.h"
#include "planner/field/map_field_on.h"

namespace jaywalk {
namespace {

/// What `make` returns for a new executor; null with the reason where there is no device or it does not serve.
template <class Make>
auto on_device(std::string& why_not, const Make& make) -> decltype(make(std::unique_ptr<CudaExecutor>())) {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess || devices == 0) {
    why_not = std::string("cuda: no device (") + cudaGetErrorString(found) + ")";
    return nullptr;
  }
  try {
    return make(std::make_unique<CudaExecutor>());
  } catch (const std::exception& error) {
    why_not = std::string("cuda: the device does not serve (") + error.what() + ")";
    return nullptr;
  }
}

}  // namespace

std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, std::string& why_not) {
  field::check(config);
  return on_device(why_not, [&](std::unique_ptr<CudaExecutor> executor) {
    return std::make_unique<field::GridPlanner<CudaExecutor>>(config, std::move(executor));
  });
}

std::unique_ptr<field::MapField> make_cuda_map_field(field::CellMap map, std::string& why_not) {
  return on_device(why_not, [&](std::unique_ptr<CudaExecutor> executor) {
    return std::make_unique<field::MapFieldOn<CudaExecutor>>(std::move(map), std::move(executor));
  });
}

}  // namespace jaywalk
