#include "firmware/backends.h"

#include <utility>

#include "hal/types/errors.h"
#include "planner/cost_to_go/fallback_planner.h"

#ifndef JAYWALK_HAS_CUDA
#define JAYWALK_HAS_CUDA 0
#endif
#if JAYWALK_HAS_CUDA
#include "cuda/cuda_planner.h"
#endif

namespace jaywalk {

#if JAYWALK_HAS_CUDA
const char* built_backends() { return "cpu, cuda"; }
#else
namespace {
std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig&, int, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
bool passes_cuda_trial(int, std::string& why_not) { return why_not = "cuda: not in this build", false; }
bool has_cuda_left_behind() { return false; }
}  // namespace
const char* built_backends() { return "cpu"; }
#endif

void refuse_cuda(const std::string& why_not) {
  throw StartupError("--backend " + why_not, "plan on the CPU: --backend cpu, or auto");
}

ChosenPlanner backed(Backend backend, std::unique_ptr<Planner> device, std::unique_ptr<Planner> cpu,
                     const std::string& why_not_cuda) {
  if (device) return {std::make_unique<FallbackPlanner>(std::move(device), std::move(cpu)), ""};
  if (backend == Backend::kCuda) refuse_cuda(why_not_cuda);
  return {std::move(cpu), JAYWALK_HAS_CUDA ? why_not_cuda : ""};
}

ChosenPlanner make_planner(const PlannerConfig& config, Backend backend, int device) {
  if (backend == Backend::kCpu) return {make_cpu_planner(config), ""};
  std::string why_not;
  auto planner = passes_cuda_trial(device, why_not) ? make_cuda_planner(config, device, why_not) : nullptr;
  return backed(backend, std::move(planner), make_cpu_planner(config), why_not);
}

ChosenPlanner make_planner(const ControlSetup& setup) {
  if (setup.make_planner != nullptr) return setup.make_planner(setup);
  if (setup.mode == PlanMode::kPaper)
    throw StartupError("mode paper: not in this program", "use the desktop program, jaywalk");
  return make_planner(setup.planner(), setup.backend, setup.device);
}

std::string tried_backend(Backend backend, int device) {
  std::string why_not;
  if (backend == Backend::kCpu) return "plans on the CPU";
  if (passes_cuda_trial(device, why_not))
    return "plans on CUDA device " + std::to_string(device) + ": trial plans have the CPU's bits";
  if (backend == Backend::kCuda) refuse_cuda(why_not);
  return "plans on the CPU (" + why_not + ")";
}

bool has_device_left_behind() { return has_cuda_left_behind(); }

}  // namespace jaywalk
