#pragma once
// What the world says of a body's way: of the place that it set out from, and of the one that it comes to.
#include "planner/tracking/bodies.h"
#include "planner/tracking/surroundings.h"

namespace jaywalk {

struct OldPlace {
  bool taken = false;    ///< beams still end there
  bool through = false;  ///< beams pass over it, or find nothing there
};

/// What became of the place that `body` set out from (Body::anchor_outline): of the points that it was seen by there,
/// the half that lies behind on its way and that it has left. Beams that end on the body itself say nothing.
[[nodiscard]] OldPlace old_place(const Body& body, const Surroundings& around) noexcept;

/// Whether one of the points ahead, of those that `body` was seen by last, stands where beams passed before
/// (EvidenceMap::seen_free). Who walks comes there as soon as he has left his own cells of the map. Posts of a heap
/// that show another side when the robot drives do not: what comes into view there was hidden, or stood there.
[[nodiscard]] bool enters_free_ground(const Body& body, const EvidenceMap& still) noexcept;

}  // namespace jaywalk
