#pragma once
// A recording of ROS's tools as a log to replay: scans, odometry, and where the laser sits.
#include <filesystem>
#include <optional>
#include <string>

#include "apps/formats/logs/recorded_log.h"
#include "hal/types/geometry.h"

namespace jaywalk::exchange {

struct BagOptions {
  std::string scan_topic = {};                 ///< empty: the only one of type LaserScan
  std::string odom_topic = {};                 ///< empty: the only one of type Odometry, where there is one
  std::optional<Pose2> robot_from_laser = {};  ///< in place of what the recording's frames say
  Pose2 otherwise = {};                        ///< where neither says it
};

/// Topics are told by their types; more than one of a type, and none of LaserScan, is an error that lists them. The
/// mount comes from the frames (/tf_static, and what never moves in /tf) between the odometry's child, else base_link
/// or base_footprint, and the scan's. Stamps are the headers', or where those are 0 the times of recording. Scans of
/// more than 2,048 beams are thinned out evenly; sweeps longer than from scan to scan give way to
/// RecordedLog::spinning_sweep. The log's remark says what was chosen. Leaves out and throws as read_bag() and
/// load_scan_odom() do; throws StartupError where the laser is not level, too.
[[nodiscard]] sim::RecordedLog load_bag(const std::filesystem::path& path, const BagOptions& options);

}  // namespace jaywalk::exchange
