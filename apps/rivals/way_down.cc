#include "apps/rivals/way_down.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::baseline {
namespace {

constexpr float kAhead_m = 0.5F;
constexpr int kDirections = 48;
constexpr float kArc_s = 0.5F;  ///< T: an arc's time

float goal_distance(const Scene& scene) noexcept {
  const float dx = scene.goal.x - scene.now.x, dy = scene.goal.y - scene.now.y;
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

cell::Heading way_down(const Scene& scene) noexcept {
  const float left_m = goal_distance(scene);
  cell::Heading best{};
  if (left_m > 1e-3F) best = {(scene.goal.x - scene.now.x) / left_m, (scene.goal.y - scene.now.y) / left_m};
  if (left_m < kAhead_m || !scene.guide.known()) return best;
  float least = Guide::kNoWay_s;
  for (int k = 0; k < kDirections; ++k) {
    const cell::Heading d = cell::heading_at(2.0F * cell::kPiF * static_cast<float>(k) / kDirections);
    const float x = scene.now.x + kAhead_m * d.x, y = scene.now.y + kAhead_m * d.y;
    const float middle = scene.guide.distance(scene.now.x + 0.5F * kAhead_m * d.x, scene.now.y + 0.5F * kAhead_m * d.y);
    const float to_go = scene.guide.time_to_go(x, y);
    if (middle > 0.8F * scene.radius && to_go < least) least = to_go, best = d;
  }
  return best;
}

float speed_to_goal(const Scene& scene) noexcept {
  return std::min(scene.bounds.speed, std::sqrt(scene.bounds.slowing * goal_distance(scene)));
}

motion::Command driven_along(const Scene& scene, cell::Heading direction, float speed) noexcept {
  const float off = cell::wrapped(cell::angle_of(direction.x, direction.y) - scene.now.heading);
  const float w = std::clamp(off / kArc_s, -scene.bounds.turn, scene.bounds.turn);
  if (std::fabs(off) > 0.5F * cell::kPiF) return {0.0F, w};
  if (std::fabs(off) < 0.05F) return {speed, w};
  const cell::Heading at = cell::heading_at(off);
  return {std::min(speed * off * at.y / (2.0F * (1.0F - at.x)), scene.bounds.speed), w};
}

}  // namespace jaywalk::baseline
