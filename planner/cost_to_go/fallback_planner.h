#pragma once
#include <time.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

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

/// Plans on a device; from the submission on in which that fails, on the processor. Some time later it asks the device
/// again: a launch may have been refused for a moment, and a kernel have been late and not lost. A device that failed
/// three times within a minute is asked again when that minute is over.
class FallbackPlanner final : public Planner {
 public:
  /// Both for the same configuration.
  FallbackPlanner(std::unique_ptr<Planner> device, std::unique_ptr<Planner> processor);

  /// What the device cannot answer the processor answers, in the same call.
  void submit(const PlanRequest& request) noexcept override;
  [[nodiscard]] const Plan& collect() noexcept override;
  /// Of the last submission.
  [[nodiscard]] FieldView view_field() const override { return answering_->view_field(); }
  /// "cuda", or "cpu (cuda: a kernel did not end in time)". Any thread.
  [[nodiscard]] const char* backend() const noexcept override { return name_.load(std::memory_order_acquire); }

  /// By the requests' stamps: seconds in which a driver gets over what it can get over.
  static constexpr Duration kAskAgainAfter = std::chrono::seconds(5);
  static constexpr Duration kWindow = std::chrono::seconds(60);

 private:
  [[nodiscard]] bool asks_device(Time now) const noexcept;
  void note_failure(Time now) noexcept;

  using Name = std::array<char, 96>;
  static constexpr std::size_t kMostFailures = 3;  ///< in the window

  std::unique_ptr<Planner> device_, processor_;
  Planner* answering_;
  Plan plan_;
  std::uint32_t submissions_ = 0;
  bool is_new_ = false;
  bool has_failed_ = false;  ///< and has not answered since
  std::size_t failures_ = 0;
  std::array<Time, kMostFailures> failed_at_;  ///< the latest, in turns
  std::array<Name, kMostFailures> names_{};    ///< likewise: a reader may still hold the last one
  std::atomic<const char*> name_;
};

}  // namespace jaywalk
