#pragma once
#include <memory>

#include "planner/motion/held_time.h"
#include "planner/motion/make_motion.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk::motion {

/// Takes a robot that stands closer to something than a turn needs away from it, before `to_goal` drives.
///
/// It creeps along one of a few arcs, looked at anew with each scan: the one at whose end the outline is farthest from
/// what stands, without coming more than a centimetre nearer meanwhile. Forward comes first, where the laser looks;
/// what the supervisor refuses is left out. It takes over at rest alone, and not among movers; where to_goal has stood
/// for three seconds beside something, at twice that distance. Thread: the loop's.
class LeavingMotion final : public Motion {
 public:
  LeavingMotion(const MotionSetup& setup, std::unique_ptr<Motion> to_goal);

  void observe(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override;
  void decide(const World& world, const Intent& intent) noexcept override;
  [[nodiscard]] MotionStatus status() const noexcept override;
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override { return to_goal_->request(world); }
  [[nodiscard]] Duration plan_every() const noexcept override { return to_goal_->plan_every(); }
  [[nodiscard]] const GoalRollouts* rollouts() const noexcept override { return to_goal_->rollouts(); }

 private:
  struct Arc {
    double sign = 1.0, curvature_per_m = 0.0;  ///< ahead or back; to the left positive
  };
  static constexpr int kBends = 11, kArcs = 2 * kBends;

  [[nodiscard]] static Arc arc(int number) noexcept;
  void look_round(const World& world) noexcept;
  [[nodiscard]] double clearance(const Pose2& map_from_robot, double least_m) const noexcept;
  [[nodiscard]] bool is_called_for(const World& world, const Intent& intent) const noexcept;
  [[nodiscard]] double worth(int number, const World& world) const noexcept;
  void choose(const World& world) noexcept;

  MotionSetup setup_;
  std::unique_ptr<Motion> to_goal_;  ///< never null
  FixedVector<Vec2, 2048> surfaces_;
  double left_m_ = 0.0;        ///< beyond this to_goal drives again
  double at_start_m_ = 0.0;    ///< clearance of the last look
  int chosen_ = -1;            ///< number of the arc; -1: to_goal drives
  std::uint32_t refused_ = 0;  ///< a bit an arc
  HeldTime held_up_, stands_;  ///< by the supervisor; of to_goal's own accord
  Vec2 refused_at_{};
  Ramp ramp_;
  Time seen_ = kNever;
};

}  // namespace jaywalk::motion
