#pragma once
#include <span>

#include "hal/types/geometry.h"
#include "planner/motion/robot_shape.h"
#include "planner/motion/way.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// When to go and when to let pass: the rule that sets the speed along a path among movers.
struct SpeedChoiceConfig {
  RobotShape robot;
  bool stands_at_worst = false;  ///< stands where every speed meets a mover at once; else goes on
  double max_speed_mps = 0.6;
  double max_accel_mps2 = 0.5;
  double body_margin_m = 0.15;  ///< between the bodies
  double zone_ahead_m = 0.6;    ///< a walker wants this much free ahead of its edge, within +-45 degrees
  double spread_mps = 0.05;     ///< what a prediction may be off, growing with time
  double horizon_s = 4.0;       ///< how far ahead conflicts count
};

/// The speed (m/s, 0 to the maximum) at which the robot, going the way from the place nearest to it, meets no mover for
/// longest; the faster of equals, and none where all meet one at once and it is to stand then: a mover that has all
/// but stopped is passing_speed()'s alone. Tries 0, 1/4, 1/2, 3/4 and all of the maximum against constant-velocity
/// predictions. An empty way gives 0. Source: our own rule; docs/explanation/algorithm.md section "speed".
[[nodiscard]] double choose_speed(const Way& way, const Pose2& map_from_robot, double speed_now_mps,
                                  std::span<const Track> tracks, const SpeedChoiceConfig& config) noexcept;

/// Where a mover will be, in the map.
struct PredictedMover {
  Vec2 position, velocity;
  double radius_m = 0.0, spread_m = 0.0;  ///< of its body; by which the prediction may be off
};

/// Whether a robot at `robot`, looking along `ahead` (a unit vector), would touch the mover or stand in the way that it
/// is about to go.
[[nodiscard]] bool in_conflict(Vec2 robot, Vec2 ahead, const PredictedMover& mover,
                               const SpeedChoiceConfig& config) noexcept;

}  // namespace jaywalk
