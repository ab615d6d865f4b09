#pragma once
// What `jaywalk check` looks at before a robot is let run.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/hal.h"

namespace jaywalk {

struct CheckedPart {
  std::string part;  ///< "scanner", "left drive", ...
  bool is_well = false;
  std::string said;    ///< what it is; where it is not well, the cause and what to do about it
  bool warns = false;  ///< well, but a run wants a word about it
};

/// "ok", "warn" or "fail".
[[nodiscard]] inline const char* state_of(const CheckedPart& part) {
  return !part.is_well ? "fail" : part.warns ? "warn" : "ok";
}

/// Throws StartupError for a device that is there and is no joystick, or has not the buttons and the stick that the
/// file counts on.
void require_joystick(const panel::JoystickSetup& setup);

/// Looks at all that a run needs: clock, real-time rights, memory, planner (a trial of its GPU), control socket, CAN
/// interface, both drives, scanner, joystick. Nothing moves, no setting of a device is changed but what makes a scanner
/// send. Where a run has the robot already, that is said and its devices are left alone. Takes some seconds:
/// `waits_for` is told of each part before.
[[nodiscard]] std::vector<CheckedPart> preflight(const RobotFile& file, const std::filesystem::path& control_socket,
                                                 Clock& clock,
                                                 const std::function<void(const std::string&)>& waits_for = {});

/// Connects to a scanner of the robot's and listens for a second: what it is, how many beams and scans a second. Throws
/// StartupError where none come, not as often as the file says, where too many beams measure nothing, or where beams
/// that are not blanked end on the robot's own outline, with which it would never drive: which ones, as the file would
/// have them. Before the loop.
[[nodiscard]] std::string check_scanner(const RobotFile& file, Clock& clock, std::size_t scanner = 0);

}  // namespace jaywalk
