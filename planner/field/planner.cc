#include "planner/planner.h"

#include <cmath>

#include "planner/field/executor.h"
#include "planner/field/grid_planner.h"

namespace jaywalk {

const char* name_of(PlanStatus status) {
  switch (status) {
    case PlanStatus::kNone:
      return "none";
    case PlanStatus::kOk:
      return "ok";
    case PlanStatus::kNoPath:
      return "no_path";
    case PlanStatus::kRobotBlocked:
      return "robot_blocked";
    case PlanStatus::kBadRequest:
      return "bad_request";
    case PlanStatus::kBackendFailed:
      return "backend_failed";
  }
  return "unknown";
}

std::int32_t grid_side_for(Vec2 start, Vec2 goal, double cell_m) {
  const double box = std::fmax(std::fabs(goal.x - start.x), std::fabs(goal.y - start.y)) / cell_m;
  const double needed = box + 2.0 * field::kWindowMargin;
  if (needed <= 256.0) return 256;
  return needed <= 512.0 || needed > 1024.0 ? 512 : 1024;
}

std::unique_ptr<Planner> make_cpu_planner(const PlannerConfig& config) {
  field::check(config);
  return std::make_unique<field::GridPlanner<field::SerialExecutor>>(config, std::make_unique<field::SerialExecutor>());
}

}  // namespace jaywalk
