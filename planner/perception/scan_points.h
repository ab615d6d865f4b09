#pragma once
// From beams to points.
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

struct ScanPoint {
  Vec2 in_robot;         ///< m, in the robot's frame at the scan's stamp
  double range_m = 0.0;  ///< along the beam, from the laser
  std::uint32_t beam = 0;
};

using ScanPoints = FixedVector<ScanPoint, kMaxBeams>;

/// Fills `out` with the scan's hits in the order of the beams; beams without a return are left out. A sweep that takes
/// time is put right: each beam starts from where a robot moving with `twist` stood when that beam was measured.
void project_scan(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist, ScanPoints& out) noexcept;

}  // namespace jaywalk
