#include "planner/motion/pursuit.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kLookAhead_m = 0.35;          // at rest; half a robot's length
constexpr double kLookAhead_s = 0.7;           // plus so much travel
constexpr double kTurnInPlaceAbove_rad = 1.0;  // looking further away than this, turn before driving
constexpr double kTurnGain_per_s = 2.0;        // turn in place at this rate a radian of error

}  // namespace

std::size_t nearest_point(const Path& path, Vec2 place) noexcept {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (distance(path[i], place) < distance(path[nearest], place)) nearest = i;
  }
  return nearest;
}

Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept {
  for (std::size_t i = nearest_point(path, robot); i + 1 < path.size(); ++i) {
    const double piece = distance(path[i], path[i + 1]);
    if (piece > ahead_m) return path[i] + (path[i + 1] - path[i]) * (ahead_m / piece);
    ahead_m -= piece;
  }
  return path.back();
}

bool Steering::turns_first() const noexcept { return std::fabs(bearing) > kTurnInPlaceAbove_rad; }

double Steering::turn_radps(double most_radps) const noexcept {
  return std::clamp(kTurnGain_per_s * bearing, -most_radps, most_radps);
}

double Steering::circle_radps(double v_mps, double most_radps) const noexcept {
  return std::clamp(curvature_per_m * v_mps, -most_radps, most_radps);
}

Steering pursue(const Path& path, const Pose2& map_from_robot, double v_mps) noexcept {
  const Vec2 target =
      inverse(map_from_robot) * look_ahead(path, map_from_robot.position(), kLookAhead_m + kLookAhead_s * v_mps);
  // The circle through here and the target that is tangent to the heading has curvature 2 y / d^2.
  return {atan2(target.y, target.x), 2.0 * target.y / std::max(dot(target, target), 1e-6)};
}

}  // namespace jaywalk
