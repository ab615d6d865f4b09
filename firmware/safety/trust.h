#pragma once
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Whether the supervisor may judge by a scan: not with another number of beams than this scanner has, nor with
/// directions that are no numbers, nor where fewer than three beams measured anything, be it that nothing is in reach:
/// a scanner that is broken, covered or blinded.
[[nodiscard]] bool is_trustworthy(const LaserScan& scan, const LaserModel& laser) noexcept;

/// Whether angles and speeds of the wheels are numbers.
[[nodiscard]] bool is_trustworthy(const WheelState& wheels) noexcept;

/// Whether what is stamped so is older at `now` than `limit`, or was never seen. A stamp more than 0.1 s ahead of now
/// (which a loop that wakes late may see) says nothing of its age: older than any limit.
[[nodiscard]] bool is_older(Time stamp, Time now, Duration limit) noexcept;

}  // namespace jaywalk
