#pragma once
#include <cstdint>

#include "hal/types/time.h"

namespace jaywalk {

/// What the wheel encoders say; the two wheels of a differential drive.
struct WheelState {
  Time stamp = kNever;
  std::uint32_t sequence = 0;  ///< grows by one a reading; 0: none yet
  double left_rad = 0.0;       ///< angle turned since start; forward is positive; never wraps
  double right_rad = 0.0;
  double left_radps = 0.0;
  double right_radps = 0.0;
};

/// What the wheels are asked to do.
struct WheelCommand {
  Time stamp = kNever;
  double left_radps = 0.0;
  double right_radps = 0.0;
};

}  // namespace jaywalk
