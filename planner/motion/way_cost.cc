#include "planner/motion/way_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr float kNoWay = std::numeric_limits<float>::infinity();
constexpr float kDiagonal = 1.41421356F;

}  // namespace

WayCost::WayCost(double radius_m) : radius_m_(radius_m), cost_(kSide * kSide, kNoWay), free_(kSide * kSide), open_() {
  open_.reserve(8 * kSide * kSide);
}

std::int32_t WayCost::node_at(Vec2 p) const noexcept {
  const Vec2 at = (p - low_) * (1.0 / kNode_m);
  const double i = std::floor(at.x + 0.5), j = std::floor(at.y + 0.5);
  const bool inside = i >= 0.0 && j >= 0.0 && i < kSide && j < kSide;
  return inside ? static_cast<std::int32_t>(j) * kSide + static_cast<std::int32_t>(i) : -1;
}

float WayCost::from(Vec2 p) const noexcept {
  const std::int32_t node = node_at(p);
  return node < 0 ? kNoWay : cost_[static_cast<std::size_t>(node)];
}

/// Dijkstra from the target. A node enters the heap at most once a neighbour, so the memory suffices.
void WayCost::settle(const BodyMap& map, Vec2 target) noexcept {
  low_ = map.low();
  std::fill(cost_.begin(), cost_.end(), kNoWay);
  for (std::int32_t j = 0; j < kSide; ++j) {
    for (std::int32_t i = 0; i < kSide; ++i) {
      const Vec2 p = low_ + Vec2{i * kNode_m, j * kNode_m};
      free_[static_cast<std::size_t>(j * kSide + i)] = map.distance_at(p) >= radius_m_ ? 1 : 0;
    }
  }
  open_.clear();
  const std::int32_t goal = node_at(target);
  if (goal < 0) return;
  cost_[static_cast<std::size_t>(goal)] = 0.0F;
  open_.push_back({0.0F, goal});
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const Entry here = open_.back();
    open_.pop_back();
    if (here.cost > cost_[static_cast<std::size_t>(here.node)]) continue;
    const std::int32_t i = here.node % kSide, j = here.node / kSide;
    for (std::int32_t dj = -1; dj <= 1; ++dj) {
      for (std::int32_t di = -1; di <= 1; ++di) {
        if (i + di < 0 || j + dj < 0 || i + di >= kSide || j + dj >= kSide) continue;
        const auto there = static_cast<std::size_t>((j + dj) * kSide + i + di);
        const float step = static_cast<float>(kNode_m) * (di != 0 && dj != 0 ? kDiagonal : 1.0F);
        if (free_[there] == 0 || here.cost + step >= cost_[there]) continue;
        cost_[there] = here.cost + step;
        open_.push_back({cost_[there], static_cast<std::int32_t>(there)});
        std::push_heap(open_.begin(), open_.end());
      }
    }
  }
}

}  // namespace jaywalk
