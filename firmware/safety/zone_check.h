#pragma once
#include <string>

#include "firmware/safety/stop_zone.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Speed (m/s) of the fastest-moving part of the footprint at the limits of speed and turn rate, both at once.
[[nodiscard]] double fastest_rim_mps(const RobotModel& model) noexcept;

/// How far that part goes until the robot stands, m: from its fastest, with the oldest scan that is accepted and the
/// slowest loop and drives that are reckoned with. The stop zone looks so far ahead.
[[nodiscard]] double longest_stop_m(const RobotModel& model, Duration tick) noexcept;

/// The supervisor's stop zone for a robot: it looks ahead as far as longest_stop_m().
[[nodiscard]] StopZoneConfig stop_zone_for(const RobotModel& model, Duration tick) noexcept;

/// No robot outruns its stop zone (SAFETY 8 and 19): before the loop. Throws StartupError, which begins with `place`,
/// where its longest stop does not fit into a laser's range, or so far out a cylinder of 70 mm fits between two of its
/// beams.
void require_zone_in_reach(const RobotModel& model, Duration tick, const std::string& place);

}  // namespace jaywalk
