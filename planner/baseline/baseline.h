#pragma once
// Planners of others, simple and honest, to hold ours against: the same tracks, the same walls, the same supervisor.
#include <span>

#include "planner/baseline/choice.h"
#include "planner/cost_to_go/guide.h"
#include "planner/motion/motion_planner.h"
#include "planner/motion/robot_motion.h"
#include "planner/tracking/track.h"

namespace jaywalk::baseline {

/// Kept beyond the circles: driving is not as exact as deciding, as ORCA's epsilon.
inline constexpr float kMargin_m = 0.05F;

/// What a baseline decides from, in the map. SI.
struct Scene {
  motion::RobotState now;
  Place goal;
  std::span<const Track> tracks;
  const Guide& guide;
  motion::MotionBounds bounds;
  float radius = 0.0F;  ///< of the circle about the robot
};

[[nodiscard]] motion::Command none(const Scene& scene) noexcept;
[[nodiscard]] motion::Command replan(const Scene& scene) noexcept;
/// Fox, Burgard and Thrun 1997, "The dynamic window approach to collision avoidance", with the progress towards the
/// goal of Brock and Khatib 1999 in the place of the heading: no dead ends. Movers stand where they are.
[[nodiscard]] motion::Command dwa(const Scene& scene) noexcept;
/// Van den Berg, Guy, Lin and Manocha 2011, "Reciprocal n-body collision avoidance", for a differential drive as in
/// Alonso-Mora and others 2013, "Optimal reciprocal collision avoidance for multiple non-holonomic robots". The robot
/// alone gives way: these movers do not.
[[nodiscard]] motion::Command orca(const Scene& scene) noexcept;

/// Decides with each scan, and drives at each tick, with the comfort limits of motion::MotionPlanner. Memory: its own
/// size. Thread: the loop's.
class BaselinePlanner {
 public:
  BaselinePlanner(Baseline which, const motion::MotionConfig& config);

  void decide(const motion::MotionInput& input, const Twist2& driven) noexcept;
  /// `permitted_before`: what became of the last wish.
  [[nodiscard]] Twist2 twist(Time now, bool has_goal, const Pose2& map_from_robot, Vec2 goal_in_map,
                             const Twist2& permitted_before) noexcept;

 private:
  Baseline which_;
  motion::MotionBounds bounds_;
  float radius_, tick_s_, tolerance_m_;
  motion::Command decided_, wished_;
  Time decided_at_ = kNever;
  float accel_ = 0.0F;  ///< of the ramp
};

}  // namespace jaywalk::baseline
