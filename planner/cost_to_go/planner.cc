#include "planner/cost_to_go/planner.h"

#include <cmath>
#include <string>

#include "hal/types/errors.h"
#include "planner/cost_to_go/time_to_go_planner.h"
#include "planner/mapping/window.h"

namespace jaywalk::field {
namespace {

bool is_side(std::int32_t side) { return side >= 64 && side <= 4096 && (side & (side - 1)) == 0; }

}  // namespace

void refuse_unless(bool makes_sense, const char* name, double value, const char* remedy) {
  if (!makes_sense) throw StartupError(std::string("planner: ") + name + " is " + std::to_string(value), remedy);
}

void check(const PlannerConfig& config) {
  const std::int32_t side = config.side_cells, most = config.max_side_cells;
  refuse_unless(config.cell_m >= 0.01 && config.cell_m <= 1.0, "cell_m", config.cell_m, "choose 0.01 to 1 m");
  refuse_unless(is_side(side), "side_cells", side, "choose 256, 512 or 1024");
  refuse_unless(is_side(most) && most >= side, "max_side_cells", most, "choose 256, 512 or 1024, not below side_cells");
}

bool is_finite(const PlanRequest& request) noexcept {
  return finite(request.map_from_robot) && std::isfinite(request.goal_in_map.x) &&
         std::isfinite(request.goal_in_map.y) && std::isfinite(request.speed_mps);
}

}  // namespace jaywalk::field

namespace jaywalk {

const char* name_of(PlanStatus status) {
  switch (status) {
    case PlanStatus::kNone: return "none";
    case PlanStatus::kOk: return "ok";
    case PlanStatus::kNoPath: return "no_path";
    case PlanStatus::kRobotBlocked: return "robot_blocked";
    case PlanStatus::kBadRequest: return "bad_request";
    case PlanStatus::kBackendFailed: return "backend_failed";
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
  return std::make_unique<field::TimeToGoPlanner>(config);
}

}  // namespace jaywalk
