#pragma once
// How a ride is to feel: one word in place of several limits.
#include <string>
#include <vector>

#include "hal/types/robot_model.h"

namespace jaywalk {

enum class Comfort { kGentle, kNormal, kBrisk };

/// In the order of the enumeration: "gentle", "normal", "brisk".
[[nodiscard]] const std::vector<std::string>& comfort_names();

/// What a profile makes of a robot's own limits, which are those of `normal`.
struct ComfortProfile {
  double speed = 1.0, accel = 1.0, jerk = 1.0;  ///< shares; turning alike, but no quicker. None is faster.
  double comfort_distance_m = 1.0;              ///< m; a pedestrian nearer than this to the robot costs
};
[[nodiscard]] ComfortProfile profile_of(Comfort comfort) noexcept;

/// SAFETY 10: no profile plans more, whatever the model has, unless the model itself has more.
inline constexpr double kMostComfortAccel_mps2 = 1.0, kMostComfortJerk_mps3 = 2.0;

/// The limits of a ride that feels so. Braking stays: it is what the drives were proved to do.
[[nodiscard]] MotionLimits limits_for(Comfort comfort, const RobotModel& model) noexcept;

}  // namespace jaywalk
