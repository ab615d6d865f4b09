#include "firmware/known_walls.h"

#include "planner/mapping/surfaces_near.h"

namespace jaywalk {

std::span<const Vec2> KnownWalls::near(const EvidenceMap& still, const Pose2& map_from_robot) noexcept {
  points_.clear();
  still_ = finite(map_from_robot) ? &still : nullptr;
  map_from_robot_ = map_from_robot;
  if (still_ == nullptr) return {};
  const Transform2 robot_from_map(inverse(map_from_robot));
  for_each_surface_near(
      still, map_from_robot.position(), reach_m_, [&](CellIndex cell) { return still.stands(cell); },
      [&](Vec2 surface) { (void)points_.push_back(robot_from_map * surface); });
  return {points_.data(), points_.size()};
}

}  // namespace jaywalk
