#pragma once
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Somebody who stands, for all that is known: the disc is his, though a laser at the height of shins sees but those.
struct Stander {
  Vec2 position_in_map;
  double radius_m = 0.0;
  Time last_seen = kNever;  ///< he, or something that stood where he does
  Time since = kNever;      ///< known to stand there
};

}  // namespace jaywalk
