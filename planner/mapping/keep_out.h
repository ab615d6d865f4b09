#pragma once
// Where the body must not be though nothing stands there. No part of perception, localisation or safety looks at it.
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/map_zones.h"
#include "planner/cell/cell.h"

namespace jaywalk {

/// A look at what KeepOutField holds; plain values. Empty (no nodes): the robot may be anywhere.
struct KeepOut {
  static constexpr float kFar_m = 2.0F;

  float low_x = 0.0F, low_y = 0.0F;    ///< the first node in the map, m
  float node_m = 0.1F;                 ///< between nodes
  std::int32_t width = 0, height = 0;  ///< nodes
  const float* distance_m = nullptr;   ///< by rows from the lowest y

  [[nodiscard]] JAYWALK_CELL bool known() const { return width > 0; }

  /// From a place to the nearest zone (m), its margin taken off: kFar_m at most, below 0 in one.
  [[nodiscard]] JAYWALK_CELL float distance(float x, float y) const {
    const float gx = (x - low_x) / node_m, gy = (y - low_y) / node_m;
    const auto last_x = static_cast<float>(width - 1), last_y = static_cast<float>(height - 1);
    if (!(gx >= 0.0F && gy >= 0.0F && gx < last_x && gy < last_y)) return kFar_m;
    const auto i = static_cast<std::int32_t>(gx), j = static_cast<std::int32_t>(gy);
    const float fx = gx - static_cast<float>(i), fy = gy - static_cast<float>(j);
    const float* d = distance_m + j * width + i;
    const float low = d[0] + fx * (d[1] - d[0]), high = d[width] + fx * (d[width + 1] - d[width]);
    return low + fy * (high - low);
  }
};

/// Distances to keep-out zones, each kZoneMargin_m wider than drawn, in nodes 0.1 m apart: computed once.
/// Memory: 4 bytes a node of the box about all zones and 2 m more. The constructor is for start-up.
class KeepOutField {
 public:
  explicit KeepOutField(std::span<const MapZone> zones);
  [[nodiscard]] KeepOut view() const noexcept;

 private:
  void add(const MapZone& zone);

  Vec2 low_;
  std::int32_t width_ = 0, height_ = 0;
  std::vector<float> distance_m_;
};

}  // namespace jaywalk
