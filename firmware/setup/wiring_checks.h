#pragma once
// What the motions of a commissioning run say about motors, encoders, wheels and scanner.
#include <string>
#include <vector>

#include "firmware/setup/wheel_nudges.h"

namespace jaywalk {

struct WiringCheck {
  std::string part;  ///< "left drive", "wheels and scanner", ...
  bool is_well = false;
  std::string said;  ///< where it is not well, the cause and what to do about it
};

/// Judges each drive by its feedback, then what the scans show of each nudge against it. Wirings that look alike are
/// named together.
[[nodiscard]] std::vector<WiringCheck> judge_nudges(const std::vector<Nudge>& nudges, const RobotModel& model);

}  // namespace jaywalk
