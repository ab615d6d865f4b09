#pragma once
#include <array>
#include <atomic>
#include <memory>

#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// Plans on a device; from the submission on in which that fails, on the processor. Once, some time later, it asks the
/// device again: a launch may have been refused for a moment, and a kernel have been late and not lost. Where the
/// device fails a second time the processor plans for good.
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

 private:
  [[nodiscard]] bool asks_device(Time now) const noexcept;
  void note_failure(Time now) noexcept;

  using Name = std::array<char, 96>;
  static constexpr int kMostFailures = 2;

  std::unique_ptr<Planner> device_, processor_;
  Planner* answering_;
  Plan plan_;
  std::uint32_t submissions_ = 0;
  bool is_new_ = false;
  bool has_failed_ = false;  ///< and has not answered since
  int failures_ = 0;
  Time failed_at_ = kNever;
  std::array<Name, kMostFailures> names_{};
  std::atomic<const char*> name_;
};

}  // namespace jaywalk
