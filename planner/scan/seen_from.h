#pragma once
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// A scan and where its laser was then, in the map. The scan outlives it.
struct SeenFrom {
  const LaserScan* scan = nullptr;
  Pose2 map_from_laser{};
};

}  // namespace jaywalk
