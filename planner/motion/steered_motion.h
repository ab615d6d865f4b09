#pragma once
#include <utility>

#include "planner/motion/motion.h"
#include "planner/motion/stick_rollouts.h"

namespace jaywalk::motion {

/// A motion to goals beside a stick: whichever the intent names drives, and the other keeps account.
class SteeredMotion final : public Motion {
 public:
  SteeredMotion(const MotionSetup& setup, std::unique_ptr<Motion> to_goal)
      : to_goal_(std::move(to_goal)), by_stick_(setup) {}

  void observe(const World& world, const Intent& intent) noexcept override {
    steered_ = intent.kind == Intent::Kind::kStick;
    to_goal_->observe(world, intent);
    by_stick_.observe(world, intent);
  }
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override {
    return steered_ ? by_stick_.command(world, intent) : to_goal_->command(world, intent);
  }
  void decide(const World& world, const Intent& intent) noexcept override {
    to_goal_->decide(world, intent);
    by_stick_.decide(world, intent);
  }
  [[nodiscard]] MotionStatus status() const noexcept override {
    MotionStatus status = to_goal_->status();
    if (!steered_) return status;
    status.rests_on = by_stick_.status().rests_on;
    status.stick_asks = by_stick_.status().stick_asks;
    return status;
  }
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override { return to_goal_->request(world); }
  [[nodiscard]] Duration plan_every() const noexcept override { return to_goal_->plan_every(); }
  [[nodiscard]] const GoalRollouts* rollouts() const noexcept override { return to_goal_->rollouts(); }

 private:
  std::unique_ptr<Motion> to_goal_;  ///< never null
  StickRollouts by_stick_;
  bool steered_ = false;
};

}  // namespace jaywalk::motion
