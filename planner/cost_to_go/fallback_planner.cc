#include "planner/cost_to_go/fallback_planner.h"

#include <cstdio>
#include <utility>

namespace jaywalk {

FallbackPlanner::FallbackPlanner(std::unique_ptr<Planner> device, std::unique_ptr<Planner> processor)
    : device_(std::move(device)),
      processor_(std::move(processor)),
      answering_(device_.get()),
      name_(device_->backend()) {
  failed_at_.fill(kNever);
}

bool FallbackPlanner::asks_device(Time now) const noexcept {
  if (!has_failed_) return true;
  const Time last = failed_at_[(failures_ - 1) % kMostFailures], first = failed_at_[failures_ % kMostFailures];
  return now >= last + kAskAgainAfter && (first == kNever || now >= first + kWindow);
}

void FallbackPlanner::note_failure(Time now) noexcept {
  Name& name = names_[failures_ % kMostFailures];
  failed_at_[failures_++ % kMostFailures] = now;
  std::snprintf(name.data(), name.size(), "%s (%s: %s)", processor_->backend(), device_->backend(), device_->failure());
  name_.store(name.data(), std::memory_order_release);
  has_failed_ = true;
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
