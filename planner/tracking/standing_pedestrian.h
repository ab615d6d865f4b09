#pragma once
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// A pedestrian that stands, for all that is known: the disc is its body, though a laser at the height of shins sees
/// but those.
struct StandingPedestrian {
  Vec2 position_in_map;
  double radius_m = 0.0;
  Time last_seen = kNever;  ///< it, or something that stood in its place
  Time since = kNever;      ///< known to stand there
};

}  // namespace jaywalk
