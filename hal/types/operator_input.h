#pragma once
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What the person in charge wants right now.
struct OperatorInput {
  Time stamp = kNever;
  bool has_goal = false;
  Vec2 goal_in_map;
  double goal_tolerance_m = 0.3;  ///< the goal counts as reached within this distance
  bool emergency_stop = false;    ///< true while the button is pressed
  bool reset = false;             ///< its rising edge clears latched faults
};

}  // namespace jaywalk
