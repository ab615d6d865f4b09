#pragma once
// Scan matching: the pose at which a scan lies on the walls of a map, with its covariance.
#include <span>

#include "hal/types/geometry.h"
#include "planner/localization/correlative_search.h"
#include "planner/mapping/evidence_map.h"
#include "planner/scan/scan_points.h"
#include "planner/tracking/track.h"

namespace jaywalk {
/// Straight piece of wall: a point on it, m in the map, and its unit normal, which may point either way.
struct LineFeature {
  Vec2 point, normal;
  double variance = 0.0;    ///< across, m^2: of its points, and of the laser's
  double normal_var = 0.0;  ///< of the normal's direction, rad^2
  bool stands = false;  ///< its surface nearest to the scan's point has been seen for a second (EvidenceMap::stands)
};

/// Fits a line to the surface points within 0.25 m of the one nearest to `p_in_map`, all of the side that is seen from
/// `laser_in_map`: a thin wall's other face lies no farther off, and taken for this one it would pull the robot
/// through. False where no such surface is near, or where they lie along no line. One hit is enough to be matched
/// against: at the start, and where walls come into view, there is no more.
[[nodiscard]] bool line_feature_near(const EvidenceMap& still, Vec2 p_in_map, Vec2 viewer_in_map,
                                     LineFeature& out) noexcept;

/// Drops the points within a hand of where each of `moving` should be at `stamp`, as seen from `map_from_robot`. Ground
/// that people walk on is free in the map: among many of them a scan would seem to contradict it, though the few walls
/// in between say where the robot is.
void mask_moving_tracks(std::span<const Track> moving, const Pose2& map_from_robot, Time stamp,
                        ScanPoints& points) noexcept;

struct MatchResult {
  bool matched = false;       ///< false: too little of the scan lies on known walls; the belief is the prediction
  bool contradicted = false;  ///< not matched, though the map knows enough of what the scan sees: it is somewhere else
  bool known_for_long = false;  ///< enough of what it lies on has stood for a second: a pedestrian walking by has not
  PoseBelief belief;
  double fit = 0.0;  ///< in [0, 1]: how well the points that are not in unknown space lie on walls, on average
  std::uint32_t points_used = 0;
};

/// Every n-th of the scan's points, `most` at most; that is at most kMostMatchPoints.
[[nodiscard]] inline MatchSample sample_of(const ScanPoints& scan, std::size_t most = kMostMatchPoints) noexcept {
  MatchSample out;
  const std::size_t stride = (scan.size() + most - 1) / most;
  for (std::size_t k = 0; k < scan.size(); k += stride) (void)out.push_back(scan[k].in_robot);
  return out;
}

/// Matches points in the robot's frame, in two steps. A search over a small window of poses (correlative_search) counts
/// how much of the scan falls on occupied cells: it finds the right valley. Then Gauss and Newton, from there: each
/// point is drawn to the straight piece of wall nearest to it, across the wall only, together with the prediction by
/// its own covariance. What the walls do not tell, as where along a corridor the robot is, stays as predicted, and
/// what errors of their fitted directions tell is taken off. Points where the map knows free space (people) draw
/// nothing.
[[nodiscard]] MatchResult match_sample(const MatchSample& sample, const ScanReference& reference,
                                       const PoseBelief& predicted) noexcept;

}  // namespace jaywalk
