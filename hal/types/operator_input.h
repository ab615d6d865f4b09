#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// A heading that does not matter.
inline constexpr double kAnyHeading = std::numeric_limits<double>::quiet_NaN();

/// What a person's stick is for. Recorded by name.
enum class StickUse {
  kNone,    ///< nothing: the robot drives to goals alone
  kShared,  ///< it drives the robot, which steers clear and stops by itself
  kByHand,  ///< it drives the robot; the supervisor alone is between it and the wheels
};

/// Where a stick stands, as shares of the robot's fastest driving and turning: -1 to 1, 0 in the middle.
struct Stick {
  double forward = 0.0, left = 0.0;

  [[nodiscard]] bool is_centred() const noexcept { return forward == 0.0 && left == 0.0; }
};

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
  bool steers = false;                      ///< a person drives by the stick; then there is no goal
  Stick stick{};                            ///< in the middle it means stop
  std::uint32_t stop_orders = 0;            ///< so far, for the page that shows them; the loop does not look at them

  /// Whether the robot is asked to move at all.
  [[nodiscard]] bool wants_motion() const noexcept { return has_goal || (steers && !stick.is_centred()); }
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
