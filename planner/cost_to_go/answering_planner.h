#pragma once
#include <time.h>

#include <array>
#include <cstddef>

#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// A planner that answers within submit(), and keeps the plan that was collected beside the one being made.
class AnsweringPlanner : public Planner {
 public:
  void submit(const PlanRequest& request) noexcept final {
    const PlanTook begin = clocks();
    Plan& plan = plans_[making()];
    plan.stamp = request.stamp;
    plan.sequence = ++submissions_;
    plan.certified = false;
    plan.reach = 0.0F;
    plan.cycles = 0;
    plan.path.clear();
    plan.predictions.clear();
    plan.guide = {};
    plan.poses = {};
    plan.status = answer(request, plan);
    if (plan.status != PlanStatus::kOk) plan.path.clear();
    const PlanTook end = clocks();
    plan.took = {end.ms - begin.ms, end.processor_ms - begin.processor_ms, end.device_ms - begin.device_ms};
    is_new_ = true;
  }
  [[nodiscard]] const Plan& collect() noexcept final {
    if (is_new_) shown_ = making();
    is_new_ = false;
    return plans_[shown_];
  }

 protected:
  /// Fills a plan that holds nothing yet; the status counts as returned.
  [[nodiscard]] virtual PlanStatus answer(const PlanRequest& request, Plan& plan) noexcept = 0;
  /// Time that a device has taken so far, ms, by its own clock.
  [[nodiscard]] virtual double device_ms() const noexcept { return 0.0; }

  /// Numbers of the two plans, for what belongs to each: the one being made, and the one that was collected.
  [[nodiscard]] std::size_t making() const noexcept { return 1 - shown_; }
  [[nodiscard]] std::size_t shown() const noexcept { return shown_; }

 private:
  [[nodiscard]] PlanTook clocks() const noexcept {
    const auto ms_of = [](clockid_t clock) {
      timespec now{};
      clock_gettime(clock, &now);
      return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
    };
    return {ms_of(CLOCK_MONOTONIC), ms_of(CLOCK_THREAD_CPUTIME_ID), device_ms()};
  }

  std::array<Plan, 2> plans_;
  std::size_t shown_ = 0;
  bool is_new_ = false;
  std::uint32_t submissions_ = 0;
};

}  // namespace jaywalk
