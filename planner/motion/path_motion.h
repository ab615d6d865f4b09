#pragma once
#include "planner/motion/follower.h"
#include "planner/motion/make_motion.h"

namespace jaywalk::motion {

/// Follows the plan's path at constant speed, never stopping: the paper's experiment.
class PathMotion final : public Motion {
 public:
  explicit PathMotion(const MotionSetup& setup);

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override;
  void decide(const World&, const Intent&) noexcept override {}
  [[nodiscard]] MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override;

 private:
  double speed_mps_;
  Follower follower_;
  MotionStatus status_;
};

}  // namespace jaywalk::motion
