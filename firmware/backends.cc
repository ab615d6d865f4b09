#include "firmware/backends.h"

#if JAYWALK_HAS_CUDA
#include "cuda/cuda_planner.h"
#endif

namespace jaywalk {

#if JAYWALK_HAS_CUDA
ChosenPlanner make_planner(const PlannerConfig& config, Backend backend) {
  if (backend == Backend::kCpu) return {make_cpu_planner(config), ""};
  std::string why_not;
  if (auto planner = make_cuda_planner(config, why_not)) return {std::move(planner), ""};
  return {make_cpu_planner(config), why_not + "; the CPU plans"};
}
const char* built_backends() { return "cpu, cuda"; }
#else
ChosenPlanner make_planner(const PlannerConfig& config, Backend backend) {
  return {make_cpu_planner(config), backend == Backend::kCuda ? "cuda: not in this build; the CPU plans" : ""};
}
const char* built_backends() { return "cpu"; }
#endif

}  // namespace jaywalk
