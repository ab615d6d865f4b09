#pragma once
#include <cmath>
#include <limits>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// A heading that does not matter.
inline constexpr double kAnyHeading = std::numeric_limits<double>::quiet_NaN();

/// What the person in charge wants right now.
struct OperatorInput {
  Time stamp = kNever;
  bool has_goal = false;
  Vec2 goal_in_map;
  double goal_tolerance_m = 0.3;            ///< the goal counts as reached within this distance
  double goal_heading_rad = kAnyHeading;    ///< wanted there, in the map; NaN: any will do
  double goal_heading_tolerance_rad = 0.1;  ///< and within this angle of that, where one is wanted
  bool emergency_stop = false;              ///< true while the button is pressed
  bool reset = false;                       ///< its rising edge clears latched faults

  [[nodiscard]] bool wants_heading() const noexcept { return has_goal && std::isfinite(goal_heading_rad); }
  /// From a robot's heading to the one wanted, the short way: in (-pi, pi], left positive; NaN where none is.
  [[nodiscard]] double heading_error_rad(const Pose2& map_from_robot) const noexcept {
    return wants_heading() ? wrap_angle(goal_heading_rad - map_from_robot.heading) : kAnyHeading;
  }
  /// Whether a robot there has what was asked for, at rest or not.
  [[nodiscard]] bool is_reached_at(const Pose2& map_from_robot) const noexcept {
    return distance(map_from_robot.position(), goal_in_map) <= goal_tolerance_m &&
           (!wants_heading() || std::fabs(heading_error_rad(map_from_robot)) <= goal_heading_tolerance_rad);
  }
};

}  // namespace jaywalk
