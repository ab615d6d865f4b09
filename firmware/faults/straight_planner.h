#pragma once
#include "planner/planner.h"

namespace jaywalk::faults {

/// What the bench does to plans.
enum class PlanFault { kNone, kNoMore, kNotFinite };

/// Plans a straight line to the goal, a point every decimetre. The matrix measures what stops a robot, in a hall where
/// nothing is in the way; the grid planner would answer the same at a hundred times the price.
class StraightPlanner final : public Planner {
 public:
  void submit(const PlanRequest& request) noexcept override {
    if (fault_ == PlanFault::kNoMore) return;
    plan_.stamp = request.stamp;
    ++plan_.sequence;
    plan_.status = PlanStatus::kOk;
    plan_.path.clear();
    const Vec2 from = request.map_from_robot.position(), way = request.goal_in_map - from;
    const double length = norm(way);
    for (double gone = 0.0; gone < length; gone += kStep_m) add(from + way * (gone / length));
    add(request.goal_in_map);
  }
  [[nodiscard]] const Plan& collect() noexcept override { return plan_; }
  [[nodiscard]] FieldView view_field() const override { return {}; }
  [[nodiscard]] const char* backend() const noexcept override { return "straight"; }
  void order(PlanFault fault) noexcept { fault_ = fault; }

 private:
  static constexpr double kStep_m = 0.1;

  void add(Vec2 point) noexcept {
    if (fault_ == PlanFault::kNotFinite) point.y = std::numeric_limits<double>::quiet_NaN();
    static_cast<void>(plan_.path.push_back(point));  // of 4096: the hall has room for 440
  }

  Plan plan_;
  PlanFault fault_ = PlanFault::kNone;
};

}  // namespace jaywalk::faults
