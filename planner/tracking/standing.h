#pragma once
// Pedestrians that stand: as wide as a pedestrian, though the map has no more of them than shins.
#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"
#include "planner/mapping/evidence_map.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/target.h"

namespace jaywalk {

/// A pedestrian that stands, for all that is known: the disc is its body, though a laser at the height of shins sees
/// but those.
struct StandingPedestrian {
  Vec2 position_in_map;
  double radius_m = 0.0;
  Time last_seen = kNever;  ///< it, or something that stood in its place
  Time since = kNever;      ///< known to stand there
};

using StandingPedestrians = FixedVector<StandingPedestrian, kMaxTracks>;

/// A target that may be a pedestrian (Existence::maybe_pedestrian) and does not move stands where it was seen last. A
/// pedestrian noted before that is no target any more stands there for as long as the map has something as near to its
/// middle as legs are, or a target stands so near, however little of it is seen; or while it may be hidden there, for
/// kRememberedS. Targets come first; of the others as many as there is room for, the latest first.
void update_standing(const Targets& targets, const EvidenceMap& still, const LineOfSight& sight, Time now,
                     StandingPedestrians& standing) noexcept;

}  // namespace jaywalk
