#pragma once
#include <array>
#include <memory>
#include <vector>

#include "planner/cost_to_go/fallback_planner.h"
#include "planner/cost_to_go/guide_field.h"
#include "planner/cost_to_go/pose_field.h"
#include "planner/mapping/window.h"

namespace jaywalk::field {

// A plan without a potential: what the time to go says of the robot's way to the goal.

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

/// The planner that drives: times to go from cells, from afar and from poses, status and path by them.
class TimeToGoPlanner final : public AnsweringPlanner {
 public:
  /// `device`: settles what is settled anew; null: the processor does. Throws StartupError for a configuration that
  /// makes no sense.
  explicit TimeToGoPlanner(const PlannerConfig& config, std::unique_ptr<CostSettler> device = nullptr);

  [[nodiscard]] FieldView view_field() const override;
  [[nodiscard]] const char* backend() const noexcept override { return device_ ? device_->name() : "cpu"; }
  [[nodiscard]] const char* failure() const noexcept override { return device_ ? device_->failure() : ""; }

 private:
  struct Result {
    Window window;
    Guide guide;
    TimeToGoField::Memory cells;
    PoseField::Memory poses;
    explicit Result(std::int32_t max_side) : cells(max_side) {}
  };

  [[nodiscard]] PlanStatus answer(const PlanRequest& request, Plan& plan) noexcept override;
  [[nodiscard]] double device_ms() const noexcept override { return device_ ? device_->took_ms() : 0.0; }
  [[nodiscard]] PlanStatus plan_by_times(const PlanRequest& request, Plan& plan) noexcept;

  std::unique_ptr<CostSettler> device_;
  GrowingWindow window_;
  TimeToGoField cells_;
  FarGuide far_;
  PoseField poses_;
  Flood flood_;
  std::array<Result, 2> results_;  ///< as AnsweringPlanner numbers them
  mutable std::vector<float> drawn_;
};

}  // namespace jaywalk::field
