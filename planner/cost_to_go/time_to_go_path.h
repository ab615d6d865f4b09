#pragma once
// A plan without a potential: what the time to go says of the robot's way to the goal.
#include "planner/cost_to_go/guide_field.h"
#include "planner/mapping/nearest_cell.h"

namespace jaywalk::field {

/// Status and path of a plan, from costs that were just settled for this request. Refers to both.
class TimeToGoPath {
 public:
  TimeToGoPath(const TimeToGoField& field, const TimeToGoRequest& request) noexcept;

  /// kOk, kNoPath or kRobotBlocked. Costs are a fixed point: kNoPath is proven on the grid, unless the field is not
  /// certified.
  [[nodiscard]] PlanStatus status() const noexcept;
  /// Of kNoPath: whether the goal is inside the window and what the robot can reach goes on beyond the window.
  [[nodiscard]] bool is_walled_off(Flood& flood) const noexcept;
  /// Of kOk: from the robot down the costs, straight on where that costs no more.
  void draw(Path& path) const noexcept;

 private:
  [[nodiscard]] std::int32_t nearest_to_robot(bool has_way) const noexcept;
  [[nodiscard]] std::int32_t straight_on(std::int32_t n) const noexcept;
  [[nodiscard]] bool costs_no_more(std::int32_t from, std::int32_t to) const noexcept;
  [[nodiscard]] Vec2 middle_of(std::int32_t n) const noexcept;

  const TimeToGoField& field_;
  const TimeToGoRequest& request_;
  const CellGraph& graph_;
  std::int32_t own_, start_;  ///< the robot's cell; the one that its way begins in, CellGraph::kNone without one
};

}  // namespace jaywalk::field
