#pragma once
// Where walls are and how long the way to the goal takes from anywhere: what motion is weighed against.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "planner/cell/cell.h"
#include "planner/mapping/known_map.h"

namespace jaywalk {

/// A place in the map in single precision, m: 0.1 mm a kilometre from the origin.
struct Place {
  float x = 0.0F, y = 0.0F;
  bool operator==(const Place&) const = default;
};

/// A look at what TimeToGoField has computed; plain values, so that it goes to any processor. Empty (side 0) before the
/// first plan. Valid as long as the plan that it came with.
struct Guide {
  /// Nothing nearer than this is as good as nothing at all.
  static constexpr float kFar_m = 2.0F;
  /// Time to the goal where there is no way to it, s.
  static constexpr float kNoWay_s = 1e4F;

  float low_x = 0.0F, low_y = 0.0F;  ///< the window's low corner in the map, m
  float cell_m = 0.1F;
  std::int32_t side = 0;           ///< cells
  bool through_unseen = false;     ///< the way from the robot leads where nothing was ever seen: others are much longer
  const Place* surface = nullptr;  ///< nearest surface to each cell's middle, in the map; very far where none is near
  const std::uint8_t* unseen = nullptr;  ///< 1: nothing was ever seen in that cell
  const float* to_go_s = nullptr;        ///< from each cell's middle at full speed; kNoWay_s where there is no way
  KeepOut keep_out{};                    ///< what is no surface, but no place for the body

  [[nodiscard]] JAYWALK_CELL bool known() const { return side > 0; }

  /// From a place to the nearest surface (m), kFar_m at most and outside the window.
  [[nodiscard]] JAYWALK_CELL float distance(float x, float y) const {
    const Spot at = spot_of(x, y);
    if (at.cell < 0) return kFar_m;
    // The nearest surface is that of one of the four cells round the place.
    const Place* s = surface + at.cell;
    const float a = squared(s[0], x, y), b = squared(s[1], x, y), c = squared(s[side], x, y),
                d = squared(s[side + 1], x, y);
    const float ab = a < b ? a : b, cd = c < d ? c : d, least = ab < cd ? ab : cd;
    return least < kFar_m * kFar_m ? std::sqrt(least) : kFar_m;
  }

  /// The same to what the robot's body must keep clear of: a surface or a keep-out zone; below 0 in one. Of no concern
  /// to pedestrians.
  [[nodiscard]] JAYWALK_CELL float room(float x, float y) const {
    const float to_surface = distance(x, y), to_zone = keep_out.known() ? keep_out.distance(x, y) : kFar_m;
    return to_zone < to_surface ? to_zone : to_surface;
  }

  /// Seconds to the goal, between the cells round a place that have a way; kNoWay_s where none has.
  [[nodiscard]] JAYWALK_CELL float time_to_go(float x, float y) const {
    const Spot at = spot_of(x, y);
    if (at.cell < 0) return kNoWay_s;
    const float* t = to_go_s + at.cell;
    return between(t[0], t[1], t[side], t[side + 1], at.fx, at.fy);
  }

  /// The same for N places at once, which a processor with vectors computes side by side: the same bits.
  template <std::size_t N>
  JAYWALK_CELL void times_to_go(const float (&x)[N], const float (&y)[N], float (&seconds)[N]) const {
    const auto last = static_cast<float>(side - 1);
    std::int32_t at[N];
    float fx[N], fy[N], t[4][N];
    bool inside[N];
    for (std::size_t n = 0; n < N; ++n) {
      const float gx = (x[n] - low_x) / cell_m - 0.5F, gy = (y[n] - low_y) / cell_m - 0.5F;
      inside[n] = (gx >= 0.0F) & (gy >= 0.0F) & (gx < last) & (gy < last);
      const float px = inside[n] ? gx : 0.0F, py = inside[n] ? gy : 0.0F;
      const auto i = static_cast<std::int32_t>(px), j = static_cast<std::int32_t>(py);
      fx[n] = px - static_cast<float>(i), fy[n] = py - static_cast<float>(j);
      at[n] = j * side + i;
    }
    for (std::size_t n = 0; n < N; ++n) {
      const float* of = to_go_s + at[n];
      t[0][n] = of[0], t[1][n] = of[1], t[2][n] = of[side], t[3][n] = of[side + 1];
    }
    for (std::size_t n = 0; n < N; ++n) {
      const float there = between(t[0][n], t[1][n], t[2][n], t[3][n], fx[n], fy[n]);
      seconds[n] = inside[n] ? there : kNoWay_s;
    }
  }

  /// Whether nothing was ever seen at a place; outside the window nothing is said.
  [[nodiscard]] JAYWALK_CELL bool is_unseen(float x, float y) const {
    const float gx = (x - low_x) / cell_m, gy = (y - low_y) / cell_m;
    const auto end = static_cast<float>(side);
    if (!(gx >= 0.0F && gy >= 0.0F && gx < end && gy < end)) return false;
    return unseen[static_cast<std::int32_t>(gy) * side + static_cast<std::int32_t>(gx)] != 0;
  }

 private:
  /// The cell whose middle lies below and left of a place, negative outside; how far beyond it the place is, in cells.
  struct Spot {
    std::int32_t cell;
    float fx, fy;
  };
  [[nodiscard]] JAYWALK_CELL Spot spot_of(float x, float y) const {
    const float gx = (x - low_x) / cell_m - 0.5F, gy = (y - low_y) / cell_m - 0.5F;
    const auto last = static_cast<float>(side - 1);
    if (!(gx >= 0.0F && gy >= 0.0F && gx < last && gy < last)) return {-1, 0.0F, 0.0F};
    const auto i = static_cast<std::int32_t>(gx), j = static_cast<std::int32_t>(gy);
    return {j * side + i, gx - static_cast<float>(i), gy - static_cast<float>(j)};
  }
  [[nodiscard]] JAYWALK_CELL static float squared(const Place& s, float x, float y) {
    const float dx = s.x - x, dy = s.y - y;
    return dx * dx + dy * dy;
  }
  /// Mean of those of four cells' times that are known, by how far a place lies from the first cell's middle.
  [[nodiscard]] JAYWALK_CELL static float between(float t00, float t10, float t01, float t11, float fx, float fy) {
    float sum = 0.0F, weight = 0.0F;
    add(t00, (1.0F - fx) * (1.0F - fy), sum, weight);
    add(t10, fx * (1.0F - fy), sum, weight);
    add(t01, (1.0F - fx) * fy, sum, weight);
    add(t11, fx * fy, sum, weight);
    return weight > 0.05F ? sum / weight : kNoWay_s;
  }
  JAYWALK_CELL static void add(float t, float w, float& sum, float& weight) {
    sum = t < kNoWay_s ? sum + w * t : sum;
    weight = t < kNoWay_s ? weight + w : weight;
  }
};

}  // namespace jaywalk
