#pragma once
#include "planner/scan/segments.h"
#include "planner/tracking/target.h"

namespace jaywalk {

/// Cuts segments where one known target ends and the next begins: pedestrians that pass so near that no jump parts
/// them. A segment is cut that begins on one and ends on another, one of which moves at least, and that is about as
/// wide as both.
void split_detections(const Targets& targets, const PointsInMap& in_map, Segments& segments) noexcept;

}  // namespace jaywalk
