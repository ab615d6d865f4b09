#pragma once
// A recording seen again by this build's localizer and tracker alone: no plan, no command, twenty times as quick.
#include <filesystem>
#include <optional>
#include <string>

#include "hal/types/geometry.h"

namespace jaywalk::bench {

struct ReliveOptions {
  std::string recording;                ///< recording.jwr, or scans as `jaywalk replay` takes them
  std::optional<std::string> odometry;  ///< beside scans
  Pose2 robot_from_laser{};             ///< of scans; a recording.jwr has its own
  std::filesystem::path out;            ///< gets robot.csv, tracks.csv and, of a simulation, movers.csv
};

/// Ticks 50 times a second, as the control loop does. The folder of a simulation's recording says where its robot and
/// movers really were. Throws StartupError.
void relive(const ReliveOptions& options);

}  // namespace jaywalk::bench
