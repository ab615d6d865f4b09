#pragma once
// Social forces on a pedestrian, m/s2: Helbing and Molnar 1995, "Social force model for pedestrian dynamics",
// Physical Review E 51, 4282. Its lengths are between points; here they are between the outlines of bodies.
#include "hal/types/geometry.h"

namespace jaywalk::sim::social {

/// Mean of the speeds that pedestrians wish, m/s; standard deviation 0.26 (section III).
inline constexpr double kWishedSpeed_mps = 1.34;
/// Standard deviation of the wished speeds over their mean.
inline constexpr double kSpeedSpread = 0.26 / 1.34;
/// Greatest over wished speed of a pedestrian (section III).
inline constexpr double kMostSpeed = 1.3;
/// Time in which a velocity approaches the wished one, s: tau.
inline constexpr double kRelaxation_s = 0.5;
/// Half the angle of sight, rad: 2 phi is 200 degrees.
inline constexpr double kHalfSight_rad = 100.0 / 180.0 * kPi;

/// Force towards a wished velocity (eq. 2).
[[nodiscard]] Vec2 towards(Vec2 wished_mps, Vec2 velocity_mps) noexcept;
/// Force away from another pedestrian, who moves at `velocity_mps` (eqs. 3 and 4). `apart_m`: from it to this one.
[[nodiscard]] Vec2 away_from_walker(Vec2 apart_m, Vec2 velocity_mps) noexcept;
/// Force away from a wall's nearest point (eq. 5). `apart_m`: from that point to the pedestrian.
[[nodiscard]] Vec2 away_from_wall(Vec2 apart_m) noexcept;
/// Returns whether a pedestrian that looks along the unit vector `ahead` has `to` in its field of view.
[[nodiscard]] bool in_sight(Vec2 ahead, Vec2 to) noexcept;
/// `force` itself, or half of it when its source lies out of sight (eqs. 8 and 9).
[[nodiscard]] Vec2 as_seen(Vec2 force, Vec2 ahead) noexcept;
/// `apart_m` between centres less both radii, 1 cm at least.
[[nodiscard]] Vec2 between_outlines(Vec2 apart_m, double radii_m) noexcept;

}  // namespace jaywalk::sim::social
