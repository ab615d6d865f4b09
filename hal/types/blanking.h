#pragma once
// Directions in which a laser sees its own robot: armrests, wheels, masts.
#include <cstddef>

#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// From one direction of the laser's frame counter-clockwise to the other, rad, both belonging to it; less than a turn.
struct BlankedSector {
  double from_rad = 0.0;
  double to_rad = 0.0;

  [[nodiscard]] double width_rad() const noexcept;
  /// How far a direction is from it, rad; 0 inside.
  [[nodiscard]] double off_rad(double direction_rad) const noexcept;
};

using Blanking = FixedVector<BlankedSector, 16>;

/// What beams measured that look into a sector was the robot: their ranges become minus infinity (LaserScan). The
/// others stay as they are.
void blank(const Blanking& sectors, LaserScan& scan) noexcept;

}  // namespace jaywalk
