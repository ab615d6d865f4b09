#include "planner/mapping/keep_out.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kNode_m = 0.1, kFar_m = static_cast<double>(KeepOut::kFar_m);
constexpr double kRim_m = kFar_m + kZoneMargin_m + 2.0 * kNode_m;  ///< beyond it every zone is far

struct Box {
  Vec2 low{1e9, 1e9}, high{-1e9, -1e9};

  void hold(const std::vector<Vec2>& points) {
    for (const Vec2 p : points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
};

std::int32_t nodes_in(double metres) { return static_cast<std::int32_t>(std::floor(metres / kNode_m)); }

}  // namespace

KeepOutField::KeepOutField(std::span<const MapZone> zones) {
  Box all;
  for (const MapZone& zone : zones) {
    if (zone.kind == ZoneKind::kKeepOut) all.hold(zone.corners);
  }
  if (!(all.low.x <= all.high.x)) return;
  low_ = {std::floor((all.low.x - kRim_m) / kNode_m) * kNode_m, std::floor((all.low.y - kRim_m) / kNode_m) * kNode_m};
  width_ = nodes_in(all.high.x + kRim_m - low_.x) + 1;
  height_ = nodes_in(all.high.y + kRim_m - low_.y) + 1;
  distance_m_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), KeepOut::kFar_m);
  for (const MapZone& zone : zones) {
    if (zone.kind == ZoneKind::kKeepOut) add(zone);
  }
}

void KeepOutField::add(const MapZone& zone) {
  Box box;
  box.hold(zone.corners);
  const std::int32_t i0 = nodes_in(box.low.x - kRim_m - low_.x), j0 = nodes_in(box.low.y - kRim_m - low_.y);
  const std::int32_t i1 = nodes_in(box.high.x + kRim_m - low_.x), j1 = nodes_in(box.high.y + kRim_m - low_.y);
  for (std::int32_t j = std::max(j0, 0); j <= std::min(j1, height_ - 1); ++j) {
    for (std::int32_t i = std::max(i0, 0); i <= std::min(i1, width_ - 1); ++i) {
      const double d = signed_distance(zone, low_ + Vec2{i * kNode_m, j * kNode_m}) - kZoneMargin_m;
      float& least =
          distance_m_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i)];
      least = std::min(least, static_cast<float>(std::max(d, -kFar_m)));
    }
  }
}

KeepOut KeepOutField::view() const noexcept {
  return {static_cast<float>(low_.x), static_cast<float>(low_.y), static_cast<float>(kNode_m), width_, height_,
          distance_m_.data()};
}

}  // namespace jaywalk
