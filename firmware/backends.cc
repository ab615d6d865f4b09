#include "firmware/backends.h"

#include <utility>

#if JAYWALK_HAS_CUDA
#include "cuda/cuda_planner.h"
#endif

namespace jaywalk {

#if JAYWALK_HAS_CUDA
const char* built_backends() { return "cpu, cuda"; }
#else
namespace {
std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig&, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
std::unique_ptr<field::MapField> make_cuda_map_field(const field::CellMap&, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
}  // namespace
const char* built_backends() { return "cpu"; }
#endif

ChosenPlanner make_planner(const PlannerConfig& config, Backend backend) {
  if (backend == Backend::kCpu) return {make_cpu_planner(config), ""};
  std::string why_not;
  if (auto planner = make_cuda_planner(config, why_not)) return {std::move(planner), ""};
  const bool is_asked_for = backend == Backend::kCuda || built_backends() != std::string("cpu");
  return {make_cpu_planner(config), is_asked_for ? why_not + "; the CPU plans" : ""};
}

ChosenMapField make_map_field(const field::CellMap& map, Backend backend) {
  if (backend == Backend::kCpu) return {field::make_cpu_map_field(map), ""};
  std::string why_not;
  if (auto solver = make_cuda_map_field(map, why_not)) return {std::move(solver), ""};
  return {field::make_cpu_map_field(map), backend == Backend::kCuda ? why_not + "; the CPU solves" : ""};
}

}  // namespace jaywalk
