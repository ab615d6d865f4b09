#pragma once
// Fixes from outside.
#include "hal/types/outside_fix.h"
#include "planner/localization/pose_search.h"

namespace jaywalk {

/// Variances of a pose that is known as exactly as any can be: no map of 10 cm cells places a robot better, and nobody
/// puts it anywhere more exactly.
inline constexpr double kLeastPositionVar = 0.005 * 0.005;  // m2
inline constexpr double kLeastHeadingVar = 0.002 * 0.002;   // rad2

/// What is believed after a fix, each part by its variance. The fix's pose is as is_place() wants it.
[[nodiscard]] PoseBelief blended(const PoseBelief& predicted, const OutsideFix& fix) noexcept;

/// Whether a robot may be there; false for NaN. Farther than 10,000 km or turned by more than 100 rad is a mistake, and
/// what that would turn the robot by no number can hold.
[[nodiscard]] bool is_place(const Pose2& map_from_robot) noexcept;

}  // namespace jaywalk
