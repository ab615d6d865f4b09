#pragma once
#include "planner/motion/follower.h"
#include "planner/motion/footprint_guide.h"
#include "planner/motion/goal_turn.h"
#include "planner/motion/make_motion.h"

namespace jaywalk::motion {

/// A body that is longer than wide: along the plan's path as fast as its outline fits, by manoeuvres where it does not,
/// and at the goal on the spot to the heading wanted there.
class LongBodyMotion final : public Motion {
 public:
  explicit LongBodyMotion(const MotionSetup& setup);

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override;
  void decide(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] MotionStatus status() const noexcept override;
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override;

 private:
  MotionSetup setup_;
  FootprintGuide guide_;
  GoalTurn turn_;
  Follower follower_;
  Time rests_on_ = kNever;
};

}  // namespace jaywalk::motion
