#pragma once
// What a scan's points may become in the map: walls, but for those of bodies.
#include "planner/tracking/bodies.h"
#include "planner/mapping/map_entry.h"

namespace jaywalk {

/// Decides for points [0, count) of the scan that `clusters` were found in and `bodies` were seen by. Who moves, or has
/// come to ground that was free and has not settled, becomes nothing. What is as wide as people, seen whole on ground
/// of which nothing is known, may be somebody who stands: no wall until it has been known for three seconds.
void decide_entries(const Bodies& bodies, const Clusters& clusters, const PointsInMap& in_map, std::size_t count,
                    const EvidenceMap& still, Time now, Entries& out) noexcept;

}  // namespace jaywalk
