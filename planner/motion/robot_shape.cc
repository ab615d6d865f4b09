#include "planner/motion/robot_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kSin45 = 0.70710678118654752;

}  // namespace

double RobotShape::distance_to(Vec2 point, Vec2 position, Vec2 ahead) const noexcept {
  const Vec2 off = point - position;
  if (radius_m > 0.0) return norm(off) - radius_m;
  return footprint.distance_to({dot(ahead, off), cross(ahead, off)});
}

double RobotShape::out_of_way(Vec2 apex, Vec2 way, Vec2 position, Vec2 ahead) const noexcept {
  const Vec2 off = position - apex;
  if (radius_m > 0.0) return (std::fabs(cross(way, off)) - dot(way, off)) * kSin45 - radius_m;
  const auto& [front, rear, half] = footprint;
  double farthest_ahead = -1e9, leftmost = -1e9, rightmost = 1e9, least = 1e9;
  for (const Vec2 corner : std::array<Vec2, 4>{{{front, half}, {front, -half}, {-rear, half}, {-rear, -half}}}) {
    const Vec2 p = off + Vec2{ahead.x * corner.x - ahead.y * corner.y, ahead.y * corner.x + ahead.x * corner.y};
    const double along = dot(way, p), aside = cross(way, p);
    farthest_ahead = std::max(farthest_ahead, along);
    leftmost = std::max(leftmost, aside);
    rightmost = std::min(rightmost, aside);
    least = std::min(least, std::fabs(aside) - along);
  }
  const bool lies_across = leftmost > 0.0 && rightmost < 0.0;  // then a part of it is straight ahead of it
  return kSin45 * (lies_across ? std::min(least, -farthest_ahead) : least);
}

}  // namespace jaywalk
