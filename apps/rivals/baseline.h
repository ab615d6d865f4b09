#pragma once
// Planners of others, simple and honest, to hold ours against: the same tracks, the same walls, the same supervisor.
#include <Eigen/Core>
#include <span>
#include <string>

#include "planner/cell/cell.h"
#include "planner/cost_to_go/guide.h"
#include "planner/motion/motion.h"
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

/// Vector from (x, y) to the track's position, m, in the map.
[[nodiscard]] inline Eigen::Vector2f offset_to(const Track& track, float x, float y) noexcept {
  return {static_cast<float>(track.position_in_map.x) - x, static_cast<float>(track.position_in_map.y) - y};
}

[[nodiscard]] motion::Command none(const Scene& scene) noexcept;
[[nodiscard]] motion::Command replan(const Scene& scene) noexcept;
/// Fox, Burgard and Thrun 1997, "The dynamic window approach to collision avoidance", with the progress towards the
/// goal of Brock and Khatib 1999 in the place of the heading: no dead ends. Movers stand where they are.
[[nodiscard]] motion::Command dwa(const Scene& scene) noexcept;
/// Van den Berg, Guy, Lin and Manocha 2011, "Reciprocal n-body collision avoidance", for a differential drive as in
/// Alonso-Mora and others 2013, "Optimal reciprocal collision avoidance for multiple non-holonomic robots". The robot
/// alone gives way: these movers do not.
[[nodiscard]] motion::Command orca(const Scene& scene) noexcept;

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
