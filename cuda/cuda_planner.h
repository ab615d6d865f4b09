#pragma once
#include <memory>
#include <string>

#include "planner/field/map_field.h"
#include "planner/planner.h"

namespace jaywalk {

/// A planner on the first CUDA device: the same stages in the same order as make_cpu_planner's, and the
/// same bits. Null with one clear line in `why_not` where there is no device or its driver or memory does not do.
/// Throws StartupError for a configuration that makes no sense.
///
/// submit() returns when the plan is made: it waits for the device. Thread: the loop's.
[[nodiscard]] std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, std::string& why_not);

/// The same for a map alone.
[[nodiscard]] std::unique_ptr<field::MapField> make_cuda_map_field(field::CellMap map, std::string& why_not);

}  // namespace jaywalk
