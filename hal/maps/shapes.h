#pragma once
#include "hal/types/geometry.h"

namespace jaywalk::sim {

/// One straight piece of wall, in the map.
struct WallSegment {
  Vec2 from, to;
};

/// A round pillar, or the body of a mover, in the map.
struct Disc {
  Vec2 centre;
  double radius_m = 0.0;
};

/// Distance (m) from a point to a segment.
[[nodiscard]] double distance(Vec2 p, const WallSegment& segment) noexcept;

/// Distance (m) along the ray (unit `direction`) to where it enters the shape; infinity when it misses. 0 from inside
/// a disc.
[[nodiscard]] double hit_range(Vec2 from, Vec2 direction, const WallSegment& segment) noexcept;
[[nodiscard]] double hit_range(Vec2 from, Vec2 direction, const Disc& disc) noexcept;

}  // namespace jaywalk::sim
