#pragma once
// Scans made by hand.
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk::tests {

/// Lays a laser's beams over its view; the ranges stay what they are.
inline void lay_beams(LaserScan& scan, const LaserModel& laser) {
  scan.beam_count = laser.beams;
  scan.first_angle_rad = static_cast<float>(-0.5 * laser.fov_rad);
  scan.angle_step_rad = static_cast<float>(laser.fov_rad / (laser.beams - 1));
  scan.range_min_m = static_cast<float>(laser.range_min_m);
  scan.range_max_m = static_cast<float>(laser.range_max_m);
}

/// A laser's first scan, with one range everywhere.
inline LaserScan scan_of(const LaserModel& laser, float range_m) {
  LaserScan scan;
  scan.sequence = 1;
  lay_beams(scan, laser);
  scan.range_m.fill(range_m);
  return scan;
}

}  // namespace jaywalk::tests
