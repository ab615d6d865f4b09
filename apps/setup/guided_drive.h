#pragma once
// The drive of a calibration: straight on and back, an eight.
#include <functional>
#include <span>
#include <vector>

#include "apps/setup/calibration_log.h"
#include "hal/hal.h"

namespace jaywalk {

struct GuidedDriveSetup {
  RobotModel model;
  Duration tick = std::chrono::milliseconds(20);
  double straight_m = 1.5;  ///< less where something stands in the way, half of it at least
  double speed_mps = 0.25, turn_radps = 0.6;
};

/// Drives armed wheels: forward, half a turn left, back, half a turn right, a circle to the left and one to the right;
/// about 50 s. It needs straight_m and the body's length ahead, and a metre to each side. The stop zone is in force all
/// the way; where a turn or a circle has no room, or a wheel does not obey, it ends at rest with a StartupError, as it
/// does where `stopped` says so. `lasers`: the model's, in its order.
/// Returns a log of each.
[[nodiscard]] std::vector<CalibrationLog> drive_guided(const GuidedDriveSetup& setup, DriveBase& drive,
                                                       std::span<LaserScanner* const> lasers, Clock& clock,
                                                       const std::function<bool()>& stopped);

}  // namespace jaywalk
