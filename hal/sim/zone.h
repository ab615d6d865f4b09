#pragma once
#include <array>

#include "hal/maps/wall_map.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

/// How far ahead of its edge a mover looks, wandering and recorded.
inline constexpr double kWanderZone = 0.5;
inline constexpr double kRecordedZone = 0.4;

/// What a mover heeds ahead of it: the points within `reach_m` of `apex` and within +-45 degrees of `ahead`.
struct Zone {
  Vec2 apex;
  Vec2 ahead;  ///< unit vector
  double reach_m = 0.0;

  [[nodiscard]] bool meets(const WallSegment& segment) const noexcept;
  [[nodiscard]] bool meets(const Disc& disc) const noexcept;
};

/// The robot as an obstacle: its footprint where it stands.
struct RobotBody {
  Footprint footprint;
  Pose2 map_from_robot;

  [[nodiscard]] std::array<WallSegment, 4> edges() const noexcept;
  /// Gap (m) between the footprint and a disc; 0 when they touch.
  [[nodiscard]] double gap(const Disc& disc) const noexcept;
  [[nodiscard]] bool in(const Zone& zone) const noexcept;
};

}  // namespace jaywalk::sim
