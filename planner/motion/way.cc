#include "planner/motion/way.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kComesRound_m = 0.3;  // of the path, before a robot looks along it

}  // namespace

Vec2 Way::looking_at(std::size_t k, double gone_m, const Pose2& robot) const noexcept {
  if (looking != nullptr) return (*looking)[k];
  const std::size_t next = std::min(k + 1, places.size() - 1);
  if (gone_m < kComesRound_m || next == 0) return direction(robot.heading);
  const Vec2 along = places[next] - places[next - 1];
  const double length = norm(along);
  return length > 0.0 ? along * (1.0 / length) : direction(robot.heading);
}

}  // namespace jaywalk
