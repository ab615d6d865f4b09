#pragma once
// What a body is judged by besides its own path.
#include "hal/types/geometry.h"
#include "planner/mapping/evidence_map.h"
#include "planner/scan/line_of_sight.h"

namespace jaywalk {

/// As a scan has it; neither is kept beyond it.
struct Surroundings {
  const LineOfSight& sight;  ///< of this scan
  const EvidenceMap& still;  ///< from all scans before it
  Pose2 map_from_laser;
  Pose2 map_from_first = map_from_laser;  ///< of the robot's first laser: anchors are kept as seen from there

  [[nodiscard]] Vec2 laser_in_map() const { return map_from_laser.position(); }
};

}  // namespace jaywalk
