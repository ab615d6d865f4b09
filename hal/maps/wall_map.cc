#include "hal/maps/wall_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk::sim {
namespace {

constexpr double kMiss = std::numeric_limits<double>::infinity();
constexpr double kEndSlack = 1e-9;  // share of a segment's length: no ray slips between two that share a corner

}  // namespace

WallMap load_wall_map(MapKind kind, const std::filesystem::path& file) {
  switch (kind) {
    case MapKind::kAria:
      return load_aria_map(file);
    case MapKind::kCylinders:
      return load_cylinder_map(file);
    case MapKind::kYaml:
      break;
  }
  return load_raster_map(file);
}

std::vector<std::filesystem::path> files_of_map(MapKind kind, const std::filesystem::path& file) {
  if (kind != MapKind::kYaml) return {file};
  return {file, picture_of_raster_map(file)};
}

double distance(Vec2 p, const WallSegment& segment) noexcept {
  const Vec2 along = segment.to - segment.from;
  const double length2 = dot(along, along);
  const double share = length2 > 0.0 ? std::clamp(dot(p - segment.from, along) / length2, 0.0, 1.0) : 0.0;
  return norm(segment.from + along * share - p);
}

double hit_range(Vec2 from, Vec2 direction, const WallSegment& segment) noexcept {
  // from + range d = segment.from + share e, solved by crossing both sides with e and with d.
  const Vec2 e = segment.to - segment.from;
  const Vec2 to_wall = segment.from - from;
  const double slant = cross(direction, e);
  if (slant == 0.0) return kMiss;  // parallel: a wall seen edge-on
  const double range = cross(to_wall, e) / slant;
  const double share = cross(to_wall, direction) / slant;
  return range >= 0.0 && share >= -kEndSlack && share <= 1.0 + kEndSlack ? range : kMiss;
}

double hit_range(Vec2 from, Vec2 direction, const Disc& disc) noexcept {
  const Vec2 to_centre = disc.centre - from;
  const double radius2 = disc.radius_m * disc.radius_m;
  if (dot(to_centre, to_centre) <= radius2) return 0.0;
  const double ahead = dot(to_centre, direction);
  const double aside = cross(to_centre, direction);
  const double half_chord2 = radius2 - aside * aside;
  return ahead > 0.0 && half_chord2 >= 0.0 ? ahead - std::sqrt(half_chord2) : kMiss;
}

}  // namespace jaywalk::sim
