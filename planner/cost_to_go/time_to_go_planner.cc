#include "planner/cost_to_go/time_to_go_planner.h"

#include <utility>

#include "planner/cost_to_go/planning_rules.h"
#include "planner/cost_to_go/time_to_go_path.h"

namespace jaywalk::field {
namespace {

const PlannerConfig& checked(const PlannerConfig& config) { return check(config), config; }

}  // namespace

TimeToGoPlanner::TimeToGoPlanner(const PlannerConfig& config, std::unique_ptr<CostSettler> device)
    : device_(std::move(device)),
      window_({{0, 0}, checked(config).side_cells, config.cell_m}, config.max_side_cells),
      cells_(config.body.inscribed_radius_m(), config.body.circumscribed_radius_m(), config.max_side_cells,
             config.keep_out, device_.get()),
      far_(config.cell_m, config.known_map),
      poses_(config.body, device_.get()),
      flood_(Grid{config.max_side_cells}.cells()),
      results_{Result(config.max_side_cells), Result(config.max_side_cells)} {}

FieldView TimeToGoPlanner::view_field() const {
  const Result& result = results_[shown()];
  drawn_.assign(static_cast<std::size_t>(result.window.grid().cells()), 0.0F);
  cells_.draw(result.guide, drawn_.data());
  return {.of = FieldView::Of::kTimeToGo,
          .low = result.window.low,
          .width = result.window.side,
          .height = result.window.side,
          .cell_m = window_.now().cell_m,
          .psi = drawn_};
}

/// Settles on the CPU what a failed device has not; the status tells the failure all the same.
PlanStatus TimeToGoPlanner::answer(const PlanRequest& request, Plan& plan) noexcept {
  if (device_ && !device_->is_ready()) return PlanStatus::kBackendFailed;
  const PlanStatus status = plan_by_times(request, plan);
  return device_ && device_->has_failed() ? PlanStatus::kBackendFailed : status;
}

PlanStatus TimeToGoPlanner::plan_by_times(const PlanRequest& request, Plan& plan) noexcept {
  if (!is_finite(request)) return PlanStatus::kBadRequest;
  const Vec2 robot = request.map_from_robot.position();
  window_.place(robot, request.goal_in_map);
  const bool is_far = !window_.now().holds(request.goal_in_map, 0);
  if (is_far) far_.settle(request.stamp, request.still, robot, request.goal_in_map);
  Result& result = results_[making()];
  result.window = window_.now();
  const TimeToGoRequest asked{.window = result.window,
                              .still = request.still,
                              .movers = request.masked,
                              .robot_in_map = robot,
                              .goal_in_map = request.goal_in_map,
                              .speed_mps = request.speed_mps,
                              .far = is_far ? &far_ : nullptr};
  plan.guide = result.guide = cells_.settle(asked, result.cells);
  if (request.poses.is_asked) {
    plan.poses = poses_.settle({.guide = plan.guide,
                                .map_from_robot = request.map_from_robot,
                                .goal_in_map = request.goal_in_map,
                                .movers = request.masked,
                                .asked = request.poses},
                               result.poses);
  }
  plan.certified = cells_.is_certified();
  plan.reach = plan.certified ? 1.0F : 0.0F;
  const TimeToGoPath path(cells_, asked);
  const bool is_closed = path.status() == PlanStatus::kOk && plan.poses.goal_closed;
  const PlanStatus status = is_closed ? PlanStatus::kNoPath : path.status();
  if (status == PlanStatus::kOk) path.draw(plan.path);
  window_.note_walled_off(status == PlanStatus::kNoPath && !is_closed && window_.can_grow() &&
                          path.is_walled_off(flood_));
  return status;
}

}  // namespace jaywalk::field
