#pragma once
// Which executors this build has, and which one a run gets. The only file that knows, but for
// mode paper's (apps/rivals/paper_mode.h).
#include <memory>
#include <string>

#include "firmware/control_setup.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

struct ChosenPlanner {
  std::unique_ptr<Planner> planner;
  std::string why_not_cuda;  ///< for the summary, where this build could but this machine cannot; else empty
};

/// kAuto takes the GPU where build and machine have one, the CPU elsewhere. A GPU is tried first: plans of a small room
/// that have not the CPU's bits are a reason not to take it. One that fails while it plans gives way to the CPU
/// (FallbackPlanner). `device`: CUDA's number. Throws StartupError where kCuda cannot be had.
[[nodiscard]] ChosenPlanner make_planner(const PlannerConfig& config, Backend backend, int device = 0);
/// The planner with the setup's configuration, backend and device; its own make_planner, where it has one. Throws
/// StartupError for mode paper without.
[[nodiscard]] ChosenPlanner make_planner(const ControlSetup& setup);
/// A device's planner, backed by the CPU's, or that one alone where there is none. Throws StartupError where kCuda
/// cannot be had.
[[nodiscard]] ChosenPlanner backed(Backend backend, std::unique_ptr<Planner> device, std::unique_ptr<Planner> cpu,
                                   const std::string& why_not_cuda);
/// Throws StartupError: a device was asked for and cannot be had.
[[noreturn]] void refuse_cuda(const std::string& why_not);

/// Tries what make_planner() would take, and says in a few words what that is. Throws StartupError like it.
[[nodiscard]] std::string tried_backend(Backend backend, int device = 0);

/// Whether this process has given up work of a device that may still run: it then ends by std::_Exit.
[[nodiscard]] bool has_device_left_behind();

/// "cpu" or "cpu, cuda": what this build has, for --version.
[[nodiscard]] const char* built_backends();

}  // namespace jaywalk
