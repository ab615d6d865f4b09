#pragma once
#include <vector>

#include "planner/motion/rollout_motion.h"

namespace jaywalk::motion {

/// Roll-outs to a goal, over the plan's guide: ways along the guide, arcs, pauses and straight escapes, and what is
/// left of the decision before, which stays unless another is better by kLeastGain.
///
/// Where the laser does not look behind, the speed backward is limited: KnownBehind.
class GoalRollouts final : public RolloutMotion {
 public:
  explicit GoalRollouts(const MotionSetup& setup) : RolloutMotion(setup), known_behind_(body_.blind.is_behind()) {}

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] const GoalRollouts* rollouts() const noexcept override { return this; }

  /// Everything that the last decision tried, cheapest first. `plan`: the one that it was made with, still valid.
  /// Allocates: for pictures, never in the loop.
  [[nodiscard]] std::vector<Alternative> alternatives(const Plan& plan) const;

 private:
  [[nodiscard]] const Guide& ground_before(const World& world) noexcept override { return world.plan.guide; }
  [[nodiscard]] const Guide& ground(const World& world) noexcept override { return world.plan.guide; }
  [[nodiscard]] bool is_to_decide(const World& world, const Intent& intent, const Guide& ground) noexcept override;
  void choose(const World& world, const Guide& ground) noexcept override;
  [[nodiscard]] Next next(const World& world, const Intent& intent, const RobotState& now) noexcept override;

  [[nodiscard]] Situation situation(const Guide& guide, const PoseGuide& poses) const noexcept;
  [[nodiscard]] float conflict_price() const noexcept;
  void note_progress(const Situation& situation, Time now) noexcept;
  void note_turning(const RobotState& now, float since_s) noexcept;
  [[nodiscard]] bool is_there(const World& world) const noexcept;

  Time stalled_since_ = kNever, noted_ = kNever;  ///< `noted_`: the last decision
  bool stands_there_ = false;                     ///< at the goal, with the heading wanted
  float turned_ = 0.0F;                           ///< the side that it turned to last
  float to_go_s_ = 0.0F, heading_ = 0.0F;         ///< at the last decision
  KnownBehind known_behind_;
};

}  // namespace jaywalk::motion
