#pragma once
#include <memory>

#include "firmware/recording/tick_record.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// Plans at once, and hands each plan out in the tick in which the recording has it: a planner with a thread of its
/// own was late by whatever its machine made of it, and did not take what it was too busy for.
class HeldPlanner final : public Planner {
 public:
  /// `record` outlives it and shows the tick at hand.
  HeldPlanner(std::unique_ptr<Planner> planner, const TickRecord& record)
      : planner_(std::move(planner)), record_(record), shown_(&planner_->collect()) {}

  void submit(const PlanRequest& request) noexcept override {
    planner_->submit(request);
    submitted_ = submitted_ == 0 ? record_.plan_sequence + 1 : submitted_ + 1;  // others came before a later part
  }
  [[nodiscard]] bool is_busy() const noexcept override { return !record_.plan_asked; }
  [[nodiscard]] const Plan& collect() noexcept override {
    if (record_.plan_sequence == submitted_) shown_ = &planner_->collect();
    return *shown_;
  }
  [[nodiscard]] FieldView view_field() const override { return planner_->view_field(); }
  [[nodiscard]] const char* backend() const noexcept override { return planner_->backend(); }

 private:
  std::unique_ptr<Planner> planner_;
  const TickRecord& record_;
  const Plan* shown_;
  std::uint32_t submitted_ = 0;
};

}  // namespace jaywalk
