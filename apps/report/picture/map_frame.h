#pragma once
#include <algorithm>

#include "apps/report/picture/scene.h"

namespace jaywalk {

/// From metres in the map to pixels on the sheet.
class MapFrame {
 public:
  /// The extent's upper left corner lies at `upper_left`; it is as large as `most` allows.
  MapFrame(const Extent& extent, Vec2 upper_left, Vec2 most)
      : extent_(extent), upper_left_(upper_left), pixels_per_m_(std::min(most.x / width_m(), most.y / height_m())) {}

  [[nodiscard]] double width_m() const { return extent_.high.x - extent_.low.x; }
  [[nodiscard]] double height_m() const { return extent_.high.y - extent_.low.y; }
  [[nodiscard]] double pixels(double metres) const { return metres * pixels_per_m_; }
  [[nodiscard]] Vec2 upper_left() const { return upper_left_; }
  [[nodiscard]] Vec2 size() const { return {pixels(width_m()), pixels(height_m())}; }
  [[nodiscard]] const Extent& extent() const { return extent_; }
  [[nodiscard]] Vec2 operator()(Vec2 p_in_map) const {
    return {upper_left_.x + pixels(p_in_map.x - extent_.low.x), upper_left_.y + pixels(extent_.high.y - p_in_map.y)};
  }

 private:
  Extent extent_;
  Vec2 upper_left_;
  double pixels_per_m_;
};

}  // namespace jaywalk
