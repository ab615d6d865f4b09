#pragma once
#include <utility>

#include "planner/motion/motion.h"
#include "planner/motion/near_returns.h"
#include "planner/motion/rollout_motion.h"

namespace jaywalk::motion {

/// Roll-outs near to what a stick asks for, past what stands near the robot, where distance from that is a cost
/// like others (stick_proposals.h). Any outline; no goal and no plan. A stick in the middle brings the robot to rest.
///
/// StickUse::kByHand: the stick's twist itself, within the comfort limits; the supervisor alone keeps it safe.
class StickRollouts final : public RolloutMotion {
 public:
  explicit StickRollouts(const MotionSetup& setup);

  void observe(const World& world, const Intent& intent) noexcept override;

 private:
  [[nodiscard]] const Guide& ground_before(const World&) noexcept override { return ground_.guide(); }
  [[nodiscard]] const Guide& ground(const World& world) noexcept override;
  [[nodiscard]] bool is_to_decide(const World& world, const Intent& intent, const Guide& ground) noexcept override;
  void choose(const World& world, const Guide& ground) noexcept override;
  [[nodiscard]] Next next(const World& world, const Intent& intent, const RobotState& now) noexcept override;

  [[nodiscard]] bool is_assisted() const noexcept { return setup_.steering == StickUse::kShared; }
  void try_shape(const Situation& situation, const StickShape& shape) noexcept;

  LocalGround ground_;
  Time seen_ = kNever;  ///< stamp of the last scan, decided on or not
  Command asked_;       ///< to be decided on
  Trajectory trial_, best_;
  StickShape best_shape_;
  float best_cost_ = 0.0F;
};

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
