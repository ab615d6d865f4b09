#pragma once
#include <filesystem>
#include <functional>
#include <span>

#include "firmware/robot/robot_file.h"
#include "hal/sim/scenario.h"
#include "hil/faults/fault_bench.h"

namespace jaywalk::faults {

/// Runs every fault on every kind of drive at 0.3, 0.6 and 1.2 m/s, in a loop of `rate_hz`, and tells each row as it
/// comes. `folder` holds the files of the run under way. Returns how many rows are not ok. Throws StartupError.
[[nodiscard]] int run_matrix(double rate_hz, const std::filesystem::path& folder,
                             const std::function<void(const FaultResult&)>& tell);

/// Every fault of the matrix, in the order in which it is printed. docs/explanation/safety.md says what each stands
/// for.
[[nodiscard]] std::span<const FaultCase> all_cases() noexcept;

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
