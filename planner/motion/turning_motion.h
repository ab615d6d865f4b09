#pragma once
#include <utility>

#include "planner/motion/follower.h"
#include "planner/motion/goal_turn.h"
#include "planner/motion/make_motion.h"

namespace jaywalk::motion {

/// Another motion of a nearly round body on the way, and at the goal a turn on the spot to the heading wanted there.
class TurningMotion final : public Motion {
 public:
  TurningMotion(const MotionSetup& setup, std::unique_ptr<Motion> to_goal);

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override;
  void decide(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] MotionStatus status() const noexcept override;
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override { return to_goal_->request(world); }
  [[nodiscard]] Duration plan_every() const noexcept override { return to_goal_->plan_every(); }
  [[nodiscard]] const GoalRollouts* rollouts() const noexcept override { return to_goal_->rollouts(); }

 private:
  MotionSetup setup_;
  std::unique_ptr<Motion> to_goal_;  ///< never null
  GoalTurn turn_;
  Follower follower_;
  Time rests_on_ = kNever;
};

}  // namespace jaywalk::motion
