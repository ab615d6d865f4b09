#include "tests/perception/room.h"

#include <cmath>
#include <limits>

namespace jaywalk::test {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

double range_to(const Wall& wall, Vec2 origin, Vec2 along) {
  const Vec2 span = wall.to - wall.from;
  const double denominator = cross(along, span);
  if (denominator == 0.0) return kNothing;
  const double range = cross(wall.from - origin, span) / denominator;
  const double share = cross(wall.from - origin, along) / denominator;
  return range > 0.0 && share >= 0.0 && share <= 1.0 ? range : kNothing;
}

double range_to(const Disc& disc, Vec2 origin, Vec2 along) {
  const double ahead = dot(disc.centre - origin, along), aside = cross(along, disc.centre - origin);
  const double chord2 = disc.radius_m * disc.radius_m - aside * aside;
  return chord2 < 0.0 || ahead < 0.0 ? kNothing : ahead - std::sqrt(chord2);
}

double ripple(std::uint32_t scan, std::uint32_t beam) {
  const std::uint32_t mixed = (scan * 2654435761U) ^ (beam * 40503U * 65537U);
  return static_cast<double>((mixed >> 8) % 2001U) / 1000.0 - 1.0;
}

}  // namespace

Room rectangle(double width, double depth, std::initializer_list<Disc> discs, std::initializer_list<Wall> walls) {
  const double x = width / 2, y = depth / 2;
  Room room{.walls = {{{-x, -y}, {x, -y}}, {{x, -y}, {x, y}}, {{x, y}, {-x, y}}, {{-x, y}, {-x, -y}}}, .discs = discs};
  room.walls.insert(room.walls.end(), walls);
  return room;
}

LaserScan scan_of(const Room& room, const Pose2& map_from_laser, std::uint32_t k, double noise_m, const Fan& fan) {
  LaserScan scan;
  scan.stamp = time_from_seconds((k - 1) / 15.0);
  scan.sequence = k;
  scan.beam_count = fan.beams;
  scan.first_angle_rad = static_cast<float>(fan.first_rad);
  scan.angle_step_rad = static_cast<float>(fan.step_rad);
  scan.range_min_m = 0.05F;
  scan.range_max_m = 20.0F;
  for (std::uint32_t b = 0; b < scan.beam_count; ++b) {
    const Vec2 along = direction(map_from_laser.heading + scan.angle_rad(b));
    double range = kNothing;
    for (const Wall& wall : room.walls) range = std::fmin(range, range_to(wall, map_from_laser.position(), along));
    for (const Disc& disc : room.discs) range = std::fmin(range, range_to(disc, map_from_laser.position(), along));
    scan.range_m[b] = static_cast<float>(range + noise_m * ripple(k, b));
  }
  return scan;
}

}  // namespace jaywalk::test
