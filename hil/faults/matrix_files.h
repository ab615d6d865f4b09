#pragma once
#include <filesystem>

#include "firmware/robot/robot_file.h"
#include "hal/sim/scenario.h"

namespace jaywalk::faults {

/// What to do where a file of the matrix cannot be written.
inline constexpr const char* kOtherOut = "choose another --out, or free some space";

/// The robot file of the matrix for one kind of drive, written into `folder` and read back like a user's: a P3-DX
/// with maximum speed `speed_mps`, a SICK scanner on a network and a loop at `rate_hz`; where asked for a second
/// scanner, looking back. Throws StartupError.
[[nodiscard]] RobotFile robot_file(DriveKind kind, double speed_mps, double rate_hz,
                                   const std::filesystem::path& folder, bool second_scanner = false);

/// The world: a hall of 44 m x 5 m, the robot at one end, looking along it. Its map is written into `folder`.
[[nodiscard]] sim::Scenario hall(const RobotModel& model, const std::filesystem::path& folder);

/// "cia402", "odrive", "vesc".
[[nodiscard]] const char* name_of(DriveKind kind) noexcept;

}  // namespace jaywalk::faults
