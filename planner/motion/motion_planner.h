#pragma once
#include <memory>
#include <vector>

#include "hal/types/robot_model.h"
#include "planner/motion/attempts.h"
#include "planner/prediction/mover_memory.h"

namespace jaywalk::motion {

struct MotionConfig {
  Footprint footprint;
  MotionLimits limits;
  LaserModel laser;
  double berth_m = 1.0;         ///< a mover's middle nearer than this to the body's discs costs
  bool constant_speed = false;  ///< one speed from start to goal, never stopping
  double goal_tolerance_m = 0.3;
  double tick_s = 0.02;
  KeepOut keep_out{};  ///< for who is steered: others know it from their guide
};

/// What a tick knows, after its command is out.
struct MotionInput {
  Seen seen;
  Vec2 goal_in_map;
  bool has_goal = false;
};

/// What was decided, for the record and for pictures.
struct Decision {
  std::uint32_t number = 0;  ///< from 1
  Time at = kNever;
  Time seen = kNever;  ///< stamp of the scan that it rests on
  Trajectory trajectory;
  Cost cost;
  std::array<RobotState, kSteps> driven{};
  // What it was decided for, beside futures and guide.
  RobotState start;
  Place goal;
  float turned = 0.0F;
  Stay stay;
  bool went_on = false;  ///< `last` was tried: what was left of the decision before
  Trajectory last;
};

/// A trajectory that was tried, for pictures.
struct Alternative {
  Trajectory trajectory;
  Cost cost;
  std::array<RobotState, kSteps> driven{};
};

/// Decides how to move: draws futures of everybody, drives trajectories through them in thought, and takes the one that
/// costs the passenger least; the last one stays unless another is better by kLeastGain. Each tick then drives on along
/// it.
///
/// Memory in the constructor. Thread: the loop's.
class MotionPlanner {
 public:
  explicit MotionPlanner(const MotionConfig& config);

  /// With each new scan, after the wheels have their command: what to do from the next tick on.
  void decide(const MotionInput& input, const Twist2& driven) noexcept;
  /// Limits the speed to `most_mps` and to the robot's own limit (m/s; infinity: the robot's own limit alone). Where
  /// the laser does not look behind, it limits the speed backward further, except over the last half metre that the
  /// robot has driven forward; at rest it forgets them within a second. Called every tick, also while a person steers.
  /// `driven_mps`: the speed of this tick.
  void limit_speed(double most_mps, double driven_mps) noexcept;
  /// This tick's wish. `permitted_before`: what became of the last one.
  [[nodiscard]] Twist2 twist(Time now, bool has_goal, const Pose2& map_from_robot, Vec2 goal_in_map,
                             const Twist2& permitted_before) noexcept;

  [[nodiscard]] const MoverMemory& memory() const { return memory_; }
  [[nodiscard]] const Decision& decision() const { return decision_; }
  [[nodiscard]] const Futures& futures() const { return *futures_; }
  /// Everything that the last decision tried, cheapest first. `guide`: the one that it was made with, still valid.
  /// Allocates: for pictures, never in the loop.
  [[nodiscard]] std::vector<Alternative> alternatives(const Guide& guide) const;

 private:
  [[nodiscard]] Situation situation(const Guide& guide) const noexcept;
  void choose(const Situation& situation) noexcept;
  [[nodiscard]] Stay stay(const RobotState& here, const Guide& guide, Time now) noexcept;
  [[nodiscard]] Command command_at(Time now) const noexcept;
  [[nodiscard]] bool is_there(const Pose2& map_from_robot, Vec2 goal) const noexcept;

  MotionConfig config_;
  RobotBody body_;
  MoverMemory memory_;
  std::unique_ptr<Futures> futures_;
  NearReturns returns_;
  Decision decision_;
  Trajectory trial_, best_;
  Cost best_cost_;
  Command wished_;      ///< last
  float accel_ = 0.0F;  ///< of the ramp
  Stay stay_;           ///< where it was when it last got on, or had nowhere to go
  Time stays_since_ = kNever;
  float turned_ = 0.0F;          ///< the side that it turned to last
  float known_behind_m_ = 0.0F;  ///< driven forward, less what it has backed since and what was forgotten at rest
};

}  // namespace jaywalk::motion
