#pragma once
#include <cstddef>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk::bench {
/// Two beliefs of where the robot was at the same moment, each in a frame of its own.
struct PosePair {
  Pose2 estimate, truth;
};

/// Medians over all stretches of the given length. NaN where the drive was shorter.
struct RelativeError {
  std::size_t stretches = 0;
  double translation_percent = 0.0;  ///< of the stretch's length
  double heading_deg = 0.0;
};

/// By how much the estimate's motion differs from the true one over stretches of `length_m` of the true way, one
/// beginning every `every_m` (relative pose error: Sturm et al. 2012, over distance as Geiger et al. 2012). Ways are
/// measured from place to place at least 5 cm apart, so that a standing robot's noise is no way.
[[nodiscard]] RelativeError relative_error(const std::vector<PosePair>& drive, double length_m, double every_m);

/// From a pair to the next: by how much the estimate's motion differs from the true one at most.
struct StepError {
  double translation_m = 0.0, heading_deg = 0.0;
};
[[nodiscard]] StepError greatest_step_error(const std::vector<PosePair>& drive);

}  // namespace jaywalk::bench
