#pragma once
// What the motions of a commissioning run say about motors, encoders, wheels and scanner.
#include <vector>

#include "apps/setup/watched_drive.h"
#include "firmware/robot/preflight.h"

namespace jaywalk {

/// Judges each drive by its feedback, then what each scanner's scans show of each nudge against it; of several each
/// part begins with the scanner's name. Wirings that look alike are named together.
[[nodiscard]] std::vector<CheckedPart> judge_nudges(const std::vector<Nudge>& nudges, const RobotModel& model);

}  // namespace jaywalk
