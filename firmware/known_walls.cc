#include "firmware/known_walls.h"

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
  decltype(supposed_) still_supposed;
  for (const Vec2 place : supposed_) {
    if (distance(place, map_from_robot.position()) > reach_m_ || still.seen_free(still.cell_at(place))) continue;
    (void)still_supposed.push_back(place);
    (void)points_.push_back(robot_from_map * place);
  }
  supposed_ = still_supposed;
  return {points_.data(), points_.size()};
}

void KnownWalls::suppose(Vec2 place) noexcept {
  constexpr double kApart_m = 0.03;  // each look at a wall's end supposes the same again
  if (still_ == nullptr) return;
  const Vec2 in_map = map_from_robot_ * place;
  for (const Vec2 other : supposed_)
    if (distance(other, in_map) < kApart_m) return;
  (void)supposed_.push_back(in_map);
}

}  // namespace jaywalk
