#pragma once
#include "firmware/safety/reasons.h"
#include "hal/types/geometry.h"

namespace jaywalk {

/// What the supervisor permits this tick, and why it is not what was wanted.
struct Verdict {
  Twist2 permitted;
  Reason reasons = Reason::kNone;
  double gap_m = 0.0;  ///< free way ahead in the direction of travel, +inf when nothing is in it
};

}  // namespace jaywalk
