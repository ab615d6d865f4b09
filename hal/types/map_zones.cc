#include "hal/types/map_zones.h"

#include <algorithm>
#include <limits>

namespace jaywalk {
namespace {

double distance_to_side(Vec2 p, Vec2 from, Vec2 to) noexcept {
  const Vec2 along = to - from;
  const double squared = dot(along, along);
  const double share = squared > 0.0 ? std::clamp(dot(p - from, along) / squared, 0.0, 1.0) : 0.0;
  return distance(p, from + along * share);
}

/// Whether a ray from `p` along x crosses this side.
bool crosses(Vec2 p, Vec2 from, Vec2 to) noexcept {
  if ((from.y > p.y) == (to.y > p.y)) return false;
  return p.x < from.x + (to.x - from.x) * ((p.y - from.y) / (to.y - from.y));
}

}  // namespace

double signed_distance(const MapZone& zone, Vec2 p) noexcept {
  double least = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t k = 0; k < zone.corners.size(); ++k) {
    const Vec2 from = zone.corners[k], to = zone.corners[(k + 1) % zone.corners.size()];
    least = std::min(least, distance_to_side(p, from, to));
    inside ^= crosses(p, from, to);
  }
  return inside ? -least : least;
}

bool is_kept_out(std::span<const MapZone> zones, Vec2 p, double within_m) noexcept {
  return std::any_of(zones.begin(), zones.end(), [&](const MapZone& zone) {
    return zone.kind == ZoneKind::kKeepOut && signed_distance(zone, p) < within_m;
  });
}

}  // namespace jaywalk
