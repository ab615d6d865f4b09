#pragma once
#include <optional>

#include "apps/formats/logs/recorded_log.h"

namespace jaywalk {

/// The yaw (rad) of the laser of a recording that says nothing of it, found by matching: localisation and tracking live
/// through the first 20 m of the recording's way, the yaw that MountCheck misses is added, and so on until less than
/// 0.02 rad is missing, seven times at most. Where the laser stands on the robot is not found. Nothing: it looks where
/// the wheels drive, within 0.1 rad; or there are no wheels, too short a way, or no yaw explains what is seen.
[[nodiscard]] std::optional<double> found_mount_yaw(const sim::RecordedLog& log);

}  // namespace jaywalk
