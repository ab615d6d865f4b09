#pragma once
// The place that a body set out from, as a scan sees it now.
#include "planner/perception/bodies.h"
#include "planner/perception/line_of_sight.h"

namespace jaywalk {

struct OldPlace {
  bool taken = false;    ///< beams still end there
  bool through = false;  ///< beams pass over it
};

/// What became of the place that `body` set out from (Body::anchor_outline): of the points that it was seen by there,
/// the half that lies behind on its way and that it has left. Beams that end on the body itself say nothing.
[[nodiscard]] OldPlace old_place(const Body& body, const LineOfSight& sight, Vec2 laser_in_map) noexcept;

}  // namespace jaywalk
