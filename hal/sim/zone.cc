#include "hal/sim/zone.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::sim {
namespace {

constexpr double kHalfRoot2 = 0.70710678118654757;

/// The point in a frame whose axes are the zone's two borders: the zone is there the quarter disc x, y >= 0.
Vec2 in_border_axes(const Zone& zone, Vec2 p) {
  const Vec2 offset = p - zone.apex;
  const double forward = dot(zone.ahead, offset) * kHalfRoot2;
  const double left = cross(zone.ahead, offset) * kHalfRoot2;
  return {forward - left, forward + left};
}

/// Narrows [begin, end] of a parameter to where from + share (to - from) is not negative.
void keep_positive(double from, double to, double& begin, double& end) {
  if (from < 0.0 && to < 0.0) end = -1.0;
  if (from < 0.0 && to >= 0.0) begin = std::max(begin, from / (from - to));
  if (from >= 0.0 && to < 0.0) end = std::min(end, from / (from - to));
}

}  // namespace

bool Zone::meets(const WallSegment& segment) const noexcept {
  const Vec2 from = in_border_axes(*this, segment.from), to = in_border_axes(*this, segment.to);
  double begin = 0.0, end = 1.0;
  keep_positive(from.x, to.x, begin, end);
  keep_positive(from.y, to.y, begin, end);
  if (begin > end) return false;
  const Vec2 along = to - from;
  return distance(Vec2{}, WallSegment{from + along * begin, from + along * end}) <= reach_m;
}

bool Zone::meets(const Disc& disc) const noexcept {
  const Vec2 centre = in_border_axes(*this, disc.centre);
  if (centre.x >= 0.0 && centre.y >= 0.0) return norm(centre) <= reach_m + disc.radius_m;
  const double to_borders =
      std::min(distance(centre, WallSegment{{}, {reach_m, 0.0}}), distance(centre, WallSegment{{}, {0.0, reach_m}}));
  return to_borders <= disc.radius_m;
}

std::array<WallSegment, 4> RobotBody::edges() const noexcept {
  const Transform2 map_from_body(map_from_robot);
  const Footprint& f = footprint;
  const Vec2 front_left = map_from_body * Vec2{f.front_m, f.half_width_m};
  const Vec2 rear_left = map_from_body * Vec2{-f.rear_m, f.half_width_m};
  const Vec2 rear_right = map_from_body * Vec2{-f.rear_m, -f.half_width_m};
  const Vec2 front_right = map_from_body * Vec2{f.front_m, -f.half_width_m};
  return {{{front_left, rear_left}, {rear_left, rear_right}, {rear_right, front_right}, {front_right, front_left}}};
}

double RobotBody::gap(const Disc& disc) const noexcept {
  return std::max(footprint.distance_to(inverse(map_from_robot) * disc.centre) - disc.radius_m, 0.0);
}

bool RobotBody::in(const Zone& zone) const noexcept {
  const double far = zone.reach_m + footprint.circumscribed_radius_m();
  const Vec2 offset = map_from_robot.position() - zone.apex;
  if (dot(offset, offset) > far * far) return false;
  const auto sides = edges();
  return std::any_of(sides.begin(), sides.end(), [&](const WallSegment& side) { return zone.meets(side); });
}

}  // namespace jaywalk::sim
