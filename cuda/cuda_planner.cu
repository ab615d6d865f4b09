#include "cuda/cuda_executor.h"
#include "cuda/cuda_planner.h"
#include "planner/field/grid_planner.h"

namespace jaywalk {

std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, std::string& why_not) {
  field::check(config);
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess || devices == 0) {
    why_not = std::string("cuda: no device (") + cudaGetErrorString(found) + ")";
    return nullptr;
  }
  try {
    return std::make_unique<field::GridPlanner<CudaExecutor>>(config, std::make_unique<CudaExecutor>());
  } catch (const std::exception& error) {
    why_not = std::string("cuda: the device does not serve (") + error.what() + ")";
    return nullptr;
  }
}

}  // namespace jaywalk
