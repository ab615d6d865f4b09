#pragma once
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"

namespace jaywalk {

enum class Gear : std::uint8_t { kForward, kBackward, kTurn };

/// One piece of a manoeuvre: how the robot gets to `map_from_robot` from the piece before.
struct ManoeuvreStep {
  Pose2 map_from_robot;
  Gear gear = Gear::kForward;
  double clearance_m = 0.0;      ///< between the outline and what stands
  double curvature_per_m = 0.0;  ///< of the arc driven, positive when it bends to the left of the heading
};

/// Poses one after the other, the first where it began. Driven pieces are about 0.1 m, turned ones 7.5 degrees.
using Manoeuvre = FixedVector<ManoeuvreStep, 256>;

}  // namespace jaywalk
