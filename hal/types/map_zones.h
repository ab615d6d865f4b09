#pragma once
// Zones that a person drew in the map: where the robot must not be, and where it drives slowly. Nothing stands there.
#include <algorithm>
#include <cstdint>
#include <limits>
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
[[nodiscard]] inline double signed_distance(const MapZone& zone, Vec2 p_in_map) noexcept {
  const Vec2 p = p_in_map;
  double least = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t k = 0; k < zone.corners.size(); ++k) {
    const Vec2 from = zone.corners[k], to = zone.corners[(k + 1) % zone.corners.size()];
    least = std::min(least, distance(p, nearest_on_segment(p, from, to)));
    // A ray from the place along x crosses this side.
    if ((from.y > p.y) != (to.y > p.y) && p.x < from.x + (to.x - from.x) * ((p.y - from.y) / (to.y - from.y)))
      inside = !inside;
  }
  return inside ? -least : least;
}

/// The smallest box that holds all keep-out zones; empty without any.
[[nodiscard]] inline Box2 box_of_keep_out(std::span<const MapZone> zones) noexcept {
  Box2 all;
  for (const MapZone& zone : zones) {
    if (zone.kind != ZoneKind::kKeepOut) continue;
    for (const Vec2 corner : zone.corners) all.hold(corner);
  }
  return all;
}

/// Whether a place lies in a keep-out zone or within `within_m` of one.
[[nodiscard]] inline bool is_kept_out(std::span<const MapZone> zones, Vec2 p_in_map, double within_m) noexcept {
  return std::any_of(zones.begin(), zones.end(), [&](const MapZone& zone) {
    return zone.kind == ZoneKind::kKeepOut && signed_distance(zone, p_in_map) < within_m;
  });
}

/// Kept between body and keep-out zone, m: what the estimate of the robot's own pose may be off by.
inline constexpr double kZoneMargin_m = 0.05;

}  // namespace jaywalk
