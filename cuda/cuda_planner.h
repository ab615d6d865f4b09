#pragma once
#include <chrono>
#include <memory>
#include <string>

#include "planner/cost_to_go/cost_settler.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// A plan on the processor takes 15 ms at 512 cells a side (docs/explanation/results.md#time): a device that takes
/// longer than this is none to wait for. A plan is then still as old as two scans at 15 Hz at most.
inline constexpr std::chrono::milliseconds kLongestWait{50};

/// A planner on the CUDA device of that number, from 0, with the bits of make_cpu_planner's. Null with one clear line
/// in `why_not` where the device, its driver or memory does not do. Throws StartupError for a configuration that makes
/// no sense. submit() waits for the device, asleep; what takes longer than `limit` between two of its answers is given
/// up: PlanStatus::kBackendFailed, and failure() says why. Thread: the loop's.
[[nodiscard]] std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, int device, std::string& why_not,
                                                         std::chrono::milliseconds limit = kLongestWait);

/// Self-test: plans twice across a small room with the device and with the CPU, which takes all kernels that drive.
/// False with one clear line in `why_not` where there is no such device, it fails, or a bit of its results differs.
/// Takes up to a second where the driver has to compile.
[[nodiscard]] bool passes_cuda_trial(int device, std::string& why_not);
/// The same of whatever settles costs.
[[nodiscard]] bool passes_trial(std::unique_ptr<field::CostSettler> settler, std::string& why_not);

/// Whether a kernel that was given up may still run. The process must then end by std::_Exit: exit() would wait for it.
[[nodiscard]] bool has_cuda_left_behind();

}  // namespace jaywalk
