#pragma once
#include <memory>

#include "planner/cost_to_go/planner.h"

namespace jaywalk::test {

/// Plans, and says that it found no path while `fails`.
class FailingPlanner final : public Planner {
 public:
  explicit FailingPlanner(const PlannerConfig& config) : planner_(make_cpu_planner(config)) {}
  void submit(const PlanRequest& request) noexcept override { planner_->submit(request); }
  [[nodiscard]] const Plan& collect() noexcept override {
    const Plan& plan = planner_->collect();
    if (!fails) return plan;
    failed_.stamp = plan.stamp;
    failed_.sequence = plan.sequence;
    failed_.status = PlanStatus::kNoPath;
    return failed_;
  }
  [[nodiscard]] FieldView view_field() const override { return planner_->view_field(); }
  [[nodiscard]] const char* backend() const noexcept override { return planner_->backend(); }
  bool fails = false;

 private:
  std::unique_ptr<Planner> planner_;
  Plan failed_;
};

}  // namespace jaywalk::test
