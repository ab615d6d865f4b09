#pragma once
#include <memory>

#include "planner/cost_to_go/planner.h"
#include "tests/firmware/simulated_drive.h"

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

/// The drive "crossing" by a planner that can fail.
struct FailingDrive : SimulatedDrive {
  explicit FailingDrive(const Edit& edit, bool constant_speed = false)
      : SimulatedDrive("crossing", 1, edit, PlanMode::kFull, "", [&](ControlSetup& setup) {
          setup.constant_speed = constant_speed;
          setup.make_planner = [](const ControlSetup& of) {
            return ChosenPlanner{std::make_unique<FailingPlanner>(of.planner()), ""};
          };
        }) {}
  void fail(bool fails) { dynamic_cast<FailingPlanner&>(planner()).fails = fails; }
};

}  // namespace jaywalk::test
