#pragma once
// The straight pieces of wall that scans are matched against.
#include "hal/types/geometry.h"
#include "planner/mapping/evidence_map.h"

namespace jaywalk {

/// A point on it, m in the map, and its unit normal, which may point either way.
struct LineFeature {
  Vec2 point, normal;
  double variance = 0.0;  ///< across, m^2: of its points, and of the laser's
  bool stands = false;    ///< its surface nearest to the scan's point has been seen for a second (EvidenceMap::stands)
};

/// Fits a line to the surface points within 0.25 m of the one nearest to `p_in_map`, all of the side that is seen from
/// `laser_in_map`: a thin wall's other face lies no farther off, and taken for this one it would pull the robot
/// through. False where no such surface is near, or where they lie along no line. One hit is enough to be matched
/// against: at the start, and where walls come into view, there is no more.
[[nodiscard]] bool line_feature_near(const EvidenceMap& still, Vec2 p_in_map, Vec2 viewer_in_map,
                                     LineFeature& out) noexcept;

}  // namespace jaywalk
