#pragma once
// A rectangular body's outline, point by point: how near it is to a surface where covering discs say too little.
#include <array>
#include <cmath>

#include "hal/types/robot_model.h"
#include "planner/cell/circle.h"
#include "planner/cost_to_go/guide.h"

namespace jaywalk::motion {

/// Points every 8 cm along the outline, corners among them, and the middles of the largest circles inside. A post
/// between two points may be nearer than said: by 2 cm where it is 3 cm away.
struct BodyOutline {
  static constexpr std::size_t kMostPoints = 96, kMostCircles = 8;
  static constexpr double kSpacing_m = 0.08;
  std::array<Place, kMostPoints> points{};  ///< in the robot's frame
  std::size_t point_count = 0;
  std::array<float, kMostCircles> ahead{};  ///< of circles' middles, m from the axle
  std::size_t circle_count = 0;
  float circle_m = 0.0F;

  /// Of a body of up to 7 m round about; beyond that the points are further apart.
  static BodyOutline of(const Footprint& body) {
    BodyOutline outline;
    const double front = body.front_m, rear = -body.rear_m, half = body.half_width_m, length = front - rear;
    const double pitch = std::max(kSpacing_m, 4.0 * (length + 2.0 * half) / static_cast<double>(kMostPoints));
    const std::array<Vec2, 5> corners{{{front, -half}, {front, half}, {rear, half}, {rear, -half}, {front, -half}}};
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
      const Vec2 side = corners[k + 1] - corners[k];
      const double pieces = std::ceil(norm(side) / pitch - 1e-9);
      for (double n = 0.0; n < pieces && outline.point_count < kMostPoints; n += 1.0) {
        const Vec2 p = corners[k] + side * (n / pieces);
        outline.points[outline.point_count++] = {static_cast<float>(p.x), static_cast<float>(p.y)};
      }
    }
    const double circle = std::min(half, 0.5 * length), row = length - 2.0 * circle;
    const double gaps = std::min(std::ceil(row / circle), static_cast<double>(kMostCircles - 1));
    outline.circle_m = static_cast<float>(circle);
    for (double k = 0.0; k <= gaps; k += 1.0)
      outline.ahead[outline.circle_count++] = static_cast<float>(rear + circle + row * k / std::max(gaps, 1.0));
    return outline;
  }

  /// From the body at (x, y), looking along `along`, to the nearest surface or keep-out zone, m; below 0 where one
  /// is inside.
  [[nodiscard]] JAYWALK_ANYWHERE float clearance(const Guide& guide, float x, float y,
                                                 const cell::Heading& along) const {
    float least = Guide::kFar_m;
    for (std::size_t k = 0; k < circle_count; ++k) {
      const float depth = circle_m - guide.room(x + ahead[k] * along.x, y + ahead[k] * along.y);
      if (depth > 0.0F && -depth < least) least = -depth;
    }
    for (std::size_t k = 0; k < point_count; ++k) {
      const Place p = points[k];
      const float d = guide.room(x + p.x * along.x - p.y * along.y, y + p.x * along.y + p.y * along.x);
      least = d < least ? d : least;
    }
    return least;
  }
};

}  // namespace jaywalk::motion
