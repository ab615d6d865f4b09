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
/// degrees either way, the best of them. The turn is exact; a way that few points tell is taken to be short. Nothing
/// where they have too little in common. Start-up only: takes about a second and allocates.
[[nodiscard]] std::optional<ScanShift> match_scans(const LaserScan& before, const LaserScan& after);

/// How badly the scans fit one another at that pose: the mean distance across the surfaces, each at most 0.1 m.
[[nodiscard]] double misfit_m(const LaserScan& before, const LaserScan& after, const Pose2& before_from_after);

}  // namespace jaywalk
