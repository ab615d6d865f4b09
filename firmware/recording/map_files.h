#pragma once
// Maps as map_server files: what the robot saw, what it knows at start.
#include <filesystem>
#include <memory>
#include <string>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/known_map.h"

namespace jaywalk {

/// Writes what the robot saw as ROS map_server files into `folder`: map.pgm (0 occupied, 254 free, 205 unknown; rows
/// from the top) and map.yaml. The picture holds the cells that are known, a cell at least. Throws StartupError where a
/// file cannot be written. Not for the loop.
void save_map(const EvidenceMap& map, const std::filesystem::path& folder);

// The map that a run begins with, and where on it the robot stands.

/// A ROS map_server file in cells of `cell_m`, whatever its own resolution and yaw: a cell that holds part of a wall is
/// one. Throws StartupError for a file that is no map, or one of more than kMostKnownCells a side.
[[nodiscard]] std::shared_ptr<const KnownMap> load_known_map(const std::filesystem::path& yaml, double cell_m);

/// Where `scan` was taken, by matching it over the whole map. Throws StartupError, beginning with `place`, where it
/// fits nowhere or in two places nearly as well. Seconds; for start-up.
[[nodiscard]] Pose2 located_on(const KnownMap& map, const LaserScan& scan, const LaserModel& laser,
                               const std::string& place);

}  // namespace jaywalk
