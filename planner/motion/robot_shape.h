#pragma once
#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// A robot's body among movers: a disc about its axle where it is nearly round, else its footprint. Thread: any.
struct RobotShape {
  double radius_m = 0.0;  ///< of the disc; 0: the footprint counts
  Footprint footprint{};

  /// From the body of a robot at `position`, which looks along `ahead` (a unit vector), to a point (m). Below 0 inside
  /// a disc, 0 inside a footprint.
  [[nodiscard]] double distance_to(Vec2 point, Vec2 position, Vec2 ahead) const noexcept;
  /// How far (m) the body stays out of the 45 degrees to either side of the way that a mover at `apex` goes (`way`, a
  /// unit vector); below 0 where part of it is in there.
  [[nodiscard]] double out_of_way(Vec2 apex, Vec2 way, Vec2 position, Vec2 ahead) const noexcept;
};

}  // namespace jaywalk
