#pragma once
#include <optional>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// How a laser moved between two scans of the same room.
struct ScanShift {
  Pose2 before_from_after;
  double left_over_m = 0.0;  ///< mean distance of a point to the other scan's surfaces, each at most 0.2 m
};

/// Matches two scans without any idea of the motion: point to line (Chen and Medioni 1992) from turns of up to 70
/// degrees either way, the best of them. Nothing where they have too little in common, or where it could slide along
/// what it sees. Start-up only: takes about a second and allocates.
[[nodiscard]] std::optional<ScanShift> match_scans(const LaserScan& before, const LaserScan& after);

}  // namespace jaywalk
