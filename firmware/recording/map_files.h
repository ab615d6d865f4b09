#pragma once
#include <filesystem>

#include "planner/mapping/evidence_map.h"

namespace jaywalk {

/// Writes what the robot saw as ROS map_server files into `folder`: map.pgm (0 occupied, 254 free, 205 unknown; rows
/// from the top) and map.yaml. The picture holds the cells that are known, a cell at least. Throws StartupError where a
/// file cannot be written. Not for the loop.
void save_map(const EvidenceMap& map, const std::filesystem::path& folder);

}  // namespace jaywalk
