#include "planner/cost_to_go/fallback_planner.h"

#include <cstdio>
#include <utility>

namespace jaywalk {

FallbackPlanner::FallbackPlanner(std::unique_ptr<Planner> device, std::unique_ptr<Planner> processor)
    : device_(std::move(device)),
      processor_(std::move(processor)),
      answering_(device_.get()),
      name_(device_->backend()) {}

bool FallbackPlanner::asks_device(Time now) const noexcept {
  return !has_failed_ || (failures_ < kMostFailures && now >= failed_at_ + kAskAgainAfter);
}

void FallbackPlanner::note_failure(Time now) noexcept {
  Name& name = names_[static_cast<std::size_t>(failures_++)];
  std::snprintf(name.data(), name.size(), "%s (%s: %s)", processor_->backend(), device_->backend(), device_->failure());
  name_.store(name.data(), std::memory_order_release);
  has_failed_ = true;
  failed_at_ = now;
}

void FallbackPlanner::submit(const PlanRequest& request) noexcept {
  ++submissions_;
  is_new_ = true;
  if (asks_device(request.stamp)) {
    device_->submit(request);
    answering_ = device_.get();
    if (device_->collect().status != PlanStatus::kBackendFailed) {
      if (std::exchange(has_failed_, false)) name_.store(device_->backend(), std::memory_order_release);
      return;
    }
    note_failure(request.stamp);
  }
  answering_ = processor_.get();
  processor_->submit(request);
}

const Plan& FallbackPlanner::collect() noexcept {
  if (std::exchange(is_new_, false)) {
    plan_ = answering_->collect();
    plan_.sequence = submissions_;
  }
  return plan_;
}

}  // namespace jaywalk
