#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hal/types/geometry.h"

namespace jaywalk {

// Lattice of poses and rules of visibility that both searches of a place share: on a map before the start
// (global_search.h), and about a pose while the loop runs (place_search.h).

inline constexpr std::int32_t kLatticeCells = 2;                        ///< from a place to the next
inline constexpr int kLatticeHeadings = 90;                             ///< in a turn
inline constexpr std::int32_t kNearCells = 3;                           ///< half a step moves points 8 m off so far
inline constexpr double kPlacesApart_m = 1.0, kPlacesApart_rad = 0.52;  ///< nearer poses are one place
inline constexpr double kBeforePoint_m = 0.3;                           ///< a wall this much nearer hides a point

[[nodiscard]] inline bool are_places_apart(const Pose2& a, const Pose2& b) noexcept {
  return distance(a.position(), b.position()) > kPlacesApart_m ||
         std::fabs(wrap_angle(a.heading - b.heading)) > kPlacesApart_rad;
}

/// True where a wall hides `point` from the laser: a beam does not pass through one (Thrun, Burgard, Fox: Probabilistic
/// Robotics, 2005, 6.3). `is_wall(place)` is asked every `step_m`.
template <class IsWall>
[[nodiscard]] bool is_hidden(Vec2 laser, Vec2 point, double step_m, const IsWall& is_wall) {
  const double range = distance(laser, point);
  const Vec2 along = (point - laser) * (1.0 / std::max(range, step_m));
  for (double gone = step_m; gone < range - kBeforePoint_m; gone += step_m)
    if (is_wall(laser + along * gone)) return true;
  return false;
}

}  // namespace jaywalk
