#pragma once
#include "planner/motion/make_motion.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk::motion {

/// Follows the plan's path at constant speed, never stopping: the paper's experiment. Pure pursuit, ramped within the
/// comfort limits; without a path it goes straight on, without a goal it comes to rest.
class PathMotion final : public Motion {
 public:
  explicit PathMotion(const MotionSetup& setup);

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override;
  void decide(const World&, const Intent&) noexcept override {}
  [[nodiscard]] MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override;

 private:
  [[nodiscard]] Twist2 target(const World& world, const Intent& intent) const noexcept;

  MotionLimits limits_;
  double tick_s_;
  TwistRamp ramp_;
  MotionStatus status_;
};

}  // namespace jaywalk::motion
