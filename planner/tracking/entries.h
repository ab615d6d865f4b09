#pragma once
// What a scan's points may become in the map: walls, but for those of bodies.
#include <span>

#include "planner/mapping/map_entry.h"
#include "planner/tracking/target.h"

namespace jaywalk {

/// Decides for the points of the scan that `detections` were found in and `targets` were seen by. What moves, or
/// has come to ground that was free and has not settled, becomes nothing. What is as wide as people, seen whole on
/// ground of which nothing is known, may be a standing pedestrian: no wall until it has been known for three seconds.
void decide_entries(const Targets& targets, const Detections& detections, std::span<const Vec2> points_in_map,
                    const EvidenceMap& still, Time now, Entries& out) noexcept;

}  // namespace jaywalk
