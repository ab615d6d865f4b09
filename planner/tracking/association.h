#pragma once
// Which detection is which target's, and where that says the target is.
#include "planner/scan/scan_points.h"
#include "planner/tracking/target.h"

namespace jaywalk {
/// Gives every detection to the likeliest target within its gate (Detection::track_id), of two as near by their own
/// doubt to the surer one; several may share one. Order of targets and detections does not matter except between exact
/// equals.
void associate(const Targets& targets, Detections& detections) noexcept;

/// What the detections given to `target` say together. Its nearest detection leads; when it is a leg, the nearest
/// other leg within a stride joins it. Detections that are left over and too far to belong are set free again.
/// False when it got none.
bool observe(const Track& track, const Appearance& known, Detections& detections, Observation& out) noexcept;

/// A new target's observation from free detection `index` and, for a leg, its nearest free fellow; both are given to
/// the track that it becomes. False, and nothing changes, when the detection is sparse and has no fellow.
[[nodiscard]] bool observe_new(Detections& detections, std::size_t index, std::uint32_t becomes_track_id,
                               Observation& out) noexcept;

/// Cuts segments where one known target ends and the next begins: pedestrians that pass so near that no jump parts
/// them. A segment is cut that begins on one and ends on another, one of which moves at least, and that is about as
/// wide as both.
void split_detections(const Targets& targets, const PointsInMap& in_map, Segments& segments) noexcept;

}  // namespace jaywalk
