#pragma once
// Which executors this build has, and which one a run gets. The only file outside cuda/ that knows.
#include <memory>
#include <string>

#include "firmware/control_setup.h"
#include "planner/field/map_field.h"
#include "planner/planner.h"

namespace jaywalk {

struct ChosenPlanner {
  std::unique_ptr<Planner> planner;
  std::string remark;  ///< one line when the choice needs a word ("cuda: no device; the CPU plans"), else empty
};

/// kAuto takes the GPU where build and machine have one, the CPU elsewhere; kCuda falls back to the CPU with a remark.
[[nodiscard]] ChosenPlanner make_planner(const PlannerConfig& config, Backend backend);

struct ChosenMapField {
  std::unique_ptr<field::MapField> solver;
  std::string remark;  ///< one line when cuda was asked for and there is none
};
[[nodiscard]] ChosenMapField make_map_field(const field::CellMap& map, Backend backend);

/// "cpu" or "cpu, cuda": what this build has, for --version.
[[nodiscard]] const char* built_backends();

}  // namespace jaywalk
