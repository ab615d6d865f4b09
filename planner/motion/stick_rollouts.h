#pragma once
#include "planner/motion/local_ground.h"
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

}  // namespace jaywalk::motion
