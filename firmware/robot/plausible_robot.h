#pragma once
#include <string>

#include "firmware/robot/robot_file.h"

namespace jaywalk {

/// Refuses what no robot is, and what would blind it (SAFETY 28): each number is in its range, but they do not go
/// together. `nominal`: the drive as the model has it. Throws StartupError "PLACE: key: cause; remedy".
///
/// What no figure tells: whether a wheel's radius, a gear or a mount is off by what another robot of the kind might
/// have. Commissioning measures those.
void require_plausible(const RobotFile& robot, const DriveModel& nominal, const std::string& place);

}  // namespace jaywalk
