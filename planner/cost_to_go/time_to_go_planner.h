#pragma once
#include <array>
#include <memory>
#include <vector>

#include "planner/cost_to_go/fallback_planner.h"
#include "planner/cost_to_go/guide_field.h"
#include "planner/cost_to_go/pose_field.h"
#include "planner/mapping/window.h"

namespace jaywalk::field {

/// The planner that drives, without a potential: times to go from cells, from afar and from poses, status and path by
/// them.
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
  FarGuide far_;
  TimeToGoField cells_;
  PoseField poses_;
  Flood flood_;
  std::array<Result, 2> results_;  ///< as AnsweringPlanner numbers them
  mutable std::vector<float> drawn_;
};

}  // namespace jaywalk::field
