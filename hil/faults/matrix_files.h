#pragma once
#include <filesystem>

#include "firmware/robot/robot_file.h"
#include "hal/sim/scenario.h"

namespace jaywalk::faults {

/// What to do where a file of the matrix cannot be written.
inline constexpr const char* kOtherOut = "choose another --out, or free some space";

/// Scanners of the matrix' robot, on a network.
struct Scanners {
  bool claims_free = false;  ///< a Hokuyo, which has a word for "nothing within reach"; else a SICK
  bool second = false;       ///< one more looks back
};

/// The robot file of the matrix for one kind of drive, written into `folder` and read back like a user's: a P3-DX
/// with maximum speed `speed_mps` and a loop at `rate_hz`. Throws StartupError.
[[nodiscard]] RobotFile robot_file(DriveKind kind, double speed_mps, double rate_hz,
                                   const std::filesystem::path& folder, const Scanners& scanners = {});

/// The world: a hall of 44 m x 5 m, the robot at one end, looking along it. Its map is written into `folder`.
[[nodiscard]] sim::Scenario hall(const RobotModel& model, const std::filesystem::path& folder);

/// "cia402", "odrive", "vesc", "pioneer".
[[nodiscard]] const char* name_of(DriveKind kind) noexcept;

}  // namespace jaywalk::faults
