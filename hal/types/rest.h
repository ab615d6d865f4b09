#pragma once
#include <cmath>

#include "hal/types/geometry.h"

namespace jaywalk {

/// Below these speeds the robot is at rest: more than encoders scatter by, less than any drive is asked for.
inline constexpr double kAtRest_mps = 0.01, kAtRest_radps = 0.02;

[[nodiscard]] inline bool is_at_rest(const Twist2& twist) {
  return std::fabs(twist.v_mps) < kAtRest_mps && std::fabs(twist.w_radps) < kAtRest_radps;
}

}  // namespace jaywalk
