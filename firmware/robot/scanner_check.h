#pragma once
#include <string>

#include "firmware/robot/robot_file.h"
#include "hal/hal.h"

namespace jaywalk {

/// Connects to a scanner of the robot's and listens for a second: what it is, how many beams and scans a second. Throws
/// StartupError where none come, not as often as the file says, where too many beams measure nothing, or where beams
/// that are not blanked end on the robot's own outline, with which it would never drive: which ones, as the file would
/// have them. Before the loop.
[[nodiscard]] std::string check_scanner(const RobotFile& file, Clock& clock, std::size_t scanner = 0);

}  // namespace jaywalk
