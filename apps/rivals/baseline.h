#pragma once
// Planners of others, simple and honest, to hold ours against: the same tracks, the same walls, the same supervisor.
#include <span>
#include <string>

#include "planner/cell/circle.h"
#include "planner/cost_to_go/guide.h"
#include "planner/motion/motion.h"
#include "planner/motion/robot_motion.h"
#include "planner/prediction/mover_history.h"
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

/// Decides with each scan, and drives at each tick, with the comfort limits of motion::RolloutMotion.
class BaselineMotion final : public motion::Motion {
 public:
  using Decide = motion::Command (*)(const Scene&) noexcept;
  BaselineMotion(Decide deciding, const motion::MotionSetup& setup);

  void observe(const motion::World& world, const motion::Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const motion::World& world, const motion::Intent& intent) noexcept override;
  void decide(const motion::World& world, const motion::Intent& intent) noexcept override;
  [[nodiscard]] motion::MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const motion::World& world) const noexcept override;
  [[nodiscard]] Duration plan_every() const noexcept override { return std::chrono::milliseconds(90); }

 private:
  Decide decide_;
  motion::MotionBounds bounds_;
  float radius_, tick_s_, tolerance_m_;
  double speed_mps_;
  motion::MoverHistory memory_;  ///< tells walls from pedestrians in the plans that it asks for
  motion::Command decided_, commanded_;
  Time decided_at_ = kNever, seen_ = kNever;
  float accel_ = 0.0F;  ///< of the ramp
  motion::MotionStatus status_;
};

/// What makes the motion of that name: "none", "replan", "dwa", "orca"; any other name: ours.
[[nodiscard]] motion::MakeMotion maker_of(const std::string& name) noexcept;

/// The direction in which the time to the goal falls fastest within half a metre of a place, past walls; straight to
/// the goal where nothing is known or it is that near.
[[nodiscard]] cell::Heading way_down(const Scene& scene) noexcept;

/// The speed, m/s, at which the robot may still come to rest at the goal.
[[nodiscard]] float speed_to_goal(const Scene& scene) noexcept;

/// Drives a holonomic velocity: in T it brings the robot to where the velocity leads, on an arc (Alonso-Mora and others
/// 2013, section 3); beyond a right angle it turns on the spot.
[[nodiscard]] motion::Command driven_along(const Scene& scene, cell::Heading direction, float speed) noexcept;

}  // namespace jaywalk::baseline
