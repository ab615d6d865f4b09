#pragma once
#include <memory>

#include "planner/motion/motion.h"
#include "planner/motion/proposals.h"
#include "planner/prediction/mover_history.h"

namespace jaywalk::motion {

/// A trajectory that was tried, for pictures.
struct Alternative {
  Trajectory trajectory;
  Cost cost;
  std::array<RobotState, kSteps> driven{};
};

/// What was decided, and all that it takes to decide the same again beside futures and guide.
struct Decision : Alternative, DecisionInput {
  std::uint32_t number = 0;  ///< from 1
  Time at = kNever;
  Time seen = kNever;    ///< stamp of the scan that it rests on
  bool went_on = false;  ///< `last` was tried: what was left of the decision before
  Trajectory last;
};

/// Pose and twist of the robot now, in the map, with the acceleration last sent, m/s2.
[[nodiscard]] RobotState state_of(const World& world, float accel = 0.0F) noexcept;

/// Drives by roll-outs: with each scan it samples joint futures of all movers, rolls proposed trajectories out among
/// them and takes the one that costs least; each tick then drives on along it, within the comfort limits. What is
/// proposed, and over which ground, the two kinds say: GoalRollouts and StickRollouts.
class RolloutMotion : public Motion {
 public:
  explicit RolloutMotion(const MotionSetup& setup);

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept final;
  void decide(const World& world, const Intent& intent) noexcept final;
  [[nodiscard]] MotionStatus status() const noexcept final { return status_; }
  [[nodiscard]] PlanRequest request(const World& world) const noexcept final;
  /// Walls are no hurry: the roll-outs look out for movers.
  [[nodiscard]] Duration plan_every() const noexcept final { return std::chrono::milliseconds(90); }

  [[nodiscard]] const Decision& decision() const { return decision_; }
  [[nodiscard]] const Futures& futures() const { return *futures_; }

 protected:
  /// A tick later on the way to what is decided.
  struct Next {
    RobotState robot;
    bool rests = false;  ///< it is to come to rest
  };

  /// Of the last decision; rest where that is too old.
  [[nodiscard]] Command command_at(Time now) const noexcept;
  /// Whether the last decision still holds, so that what is left of it may be gone on with.
  [[nodiscard]] bool holds(Time now) const noexcept { return decision_.at != kNever && now - decision_.at < kHoldsFor; }
  /// What is left of the last decision.
  [[nodiscard]] Trajectory rest_of_decision(Time now) const noexcept {
    return shifted(decision_.trajectory, static_cast<float>(to_seconds(now - decision_.at)));
  }
  [[nodiscard]] float tick_s() const noexcept { return static_cast<float>(setup_.tick_s); }

  MotionSetup setup_;
  RobotBody body_;
  std::unique_ptr<Futures> futures_;
  NearReturns returns_;
  Decision decision_;
  MotionStatus status_;
  MoverHistory memory_;
  float accel_ = 0.0F;  ///< of the ramp, m/s2, as it was last sent

 private:
  /// The ground that movers were seen on; of this scan once their bodies are known.
  [[nodiscard]] virtual const Guide& ground_before(const World& world) noexcept = 0;
  [[nodiscard]] virtual const Guide& ground(const World& world) noexcept = 0;
  /// Whether there is anything to decide.
  [[nodiscard]] virtual bool is_to_decide(const World& world, const Intent& intent, const Guide& ground) noexcept = 0;
  /// Takes the best trajectory of those that it proposes.
  virtual void choose(const World& world, const Guide& ground) noexcept = 0;
  [[nodiscard]] virtual Next next(const World& world, const Intent& intent, const RobotState& now) noexcept = 0;

  [[nodiscard]] bool heading_counts(const World& world) const noexcept;
  [[nodiscard]] PoseRequest poses_asked(const World& world) const noexcept;
  void place_unseen_walls(const World& world) noexcept;

  FixedVector<Vec2, kMaxUnseenWalls> unseen_walls_;  ///< World's, in the map
  Command commanded_;                                ///< last
  float braked_ = 0.0F;                              ///< what the brake took last, m/s2
};

}  // namespace jaywalk::motion
