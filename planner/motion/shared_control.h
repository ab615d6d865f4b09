#pragma once
#include <memory>

#include "planner/motion/judge.h"
#include "planner/cost_to_go/local_ground.h"
#include "planner/motion/motion_planner.h"
#include "planner/prediction/mover_memory.h"

namespace jaywalk::motion {

/// Drives by a person's stick: with each scan it tries trajectories near to what the stick asks for, through sampled
/// futures of all movers and past what stands, and takes the one that costs least, where distance from the wish is a
/// cost like others (wish.h). Any outline; no goal and no field. A stick in the middle brings the robot to rest.
///
/// Memory in the constructor. Thread: the loop's.
class SharedControl {
 public:
  /// Not `assisted`: the stick's twist itself, within the comfort limits; the supervisor alone keeps it safe.
  SharedControl(const MotionConfig& config, bool assisted);

  /// With each new scan, after the wheels have their command. `seen.guide` is not looked at: walls come from
  /// `seen.still`.
  void decide(const Seen& seen, const Stick& stick, const Twist2& driven) noexcept;
  /// MotionPlanner's: what a stick that is pushed all the way asks for from now on.
  void limit_speed(double most_mps) noexcept { limit_speed_of(body_.bounds, limits_, most_mps); }
  /// This tick's wish. `permitted_before`: what became of the last one.
  [[nodiscard]] Twist2 twist(Time now, const Stick& stick, const Twist2& permitted_before) noexcept;

  /// What the stick asks for.
  [[nodiscard]] Twist2 asked(const Stick& stick) const noexcept;
  /// Stamp of the scan that was looked at last.
  [[nodiscard]] Time seen() const noexcept { return seen_; }

 private:
  void choose(const Situation& situation, bool may_go_on, float gone_s) noexcept;
  void try_shape(const Situation& situation, const WishShape& shape) noexcept;
  [[nodiscard]] Command decided_at(Time now, const Command& asked) const noexcept;

  MotionLimits limits_;
  RobotBody body_;
  bool assisted_;
  float tick_s_;
  LocalGround ground_;
  MoverMemory memory_;
  std::unique_ptr<Futures> futures_;
  NearReturns returns_;
  std::uint32_t number_ = 0;
  Time decided_ = kNever, seen_ = kNever;
  Command asked_;  ///< that was decided on
  Trajectory chosen_, trial_, best_;
  WishShape best_shape_;
  float best_cost_ = 0.0F;
  Command wished_;      ///< last
  float accel_ = 0.0F;  ///< of the ramp
};

}  // namespace jaywalk::motion
