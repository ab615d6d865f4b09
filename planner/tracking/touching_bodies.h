#pragma once
#include "planner/tracking/bodies.h"
#include "planner/scan/segments.h"

namespace jaywalk {

/// Cuts segments where one known body ends and the next begins: whoever passes another so near that no jump parts them.
/// A segment is cut that begins on one and ends on another, one of which moves at least, and that is about as wide as
/// both.
void cut_between(const Bodies& bodies, const PointsInMap& in_map, Segments& segments) noexcept;

}  // namespace jaywalk
