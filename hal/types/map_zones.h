#pragma once
// Zones that a person drew in the map: where the robot must not be, and where it drives slowly. Nothing stands there.
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {

enum class ZoneKind : std::uint8_t { kKeepOut, kSpeed };

struct MapZone {
  ZoneKind kind = ZoneKind::kKeepOut;
  std::vector<Vec2> corners;  ///< in the map, in order either way round; three at least, sides that do not cross
  double speed_mps = 0.0;     ///< of a speed zone: fastest inside
};

/// From a place to the nearest point of the zone's edge, m; below 0 inside.
[[nodiscard]] double signed_distance(const MapZone& zone, Vec2 p_in_map) noexcept;

/// Whether a place lies in a keep-out zone or within `within_m` of one.
[[nodiscard]] bool is_kept_out(std::span<const MapZone> zones, Vec2 p_in_map, double within_m) noexcept;

/// Kept between body and keep-out zone, m: what the estimate of the robot's own pose may be off by.
inline constexpr double kZoneMargin_m = 0.05;

}  // namespace jaywalk
