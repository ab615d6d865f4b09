#pragma once
// A plan's path as recordings and messages have it: in whole millimetres.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "hal/types/fixed_vector.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// A place in the map, mm; within +-2,147 km.
struct PointMm {
  std::int32_t x = 0, y = 0;
  bool operator==(const PointMm&) const = default;
};

[[nodiscard]] inline PointMm in_mm(Vec2 p) noexcept {
  const auto whole = [](double metres) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::clamp(std::floor(metres * 1000.0 + 0.5), -kMost, kMost));
  };
  return {whole(p.x), whole(p.y)};
}
[[nodiscard]] inline Vec2 in_metres(PointMm p) noexcept { return {p.x / 1000.0, p.y / 1000.0}; }

struct PlannedPath {
  Time stamp = kNever;                            ///< of the scan that the plan rests on
  FixedVector<PointMm, kMaxPathPoints> points{};  ///< from the robot to the goal; empty: no path
};

/// The path of `plan`; none unless its status is kOk. Finite points, as a plan has them.
inline void keep_path(const Plan& plan, PlannedPath& path) noexcept {
  path.stamp = plan.stamp;
  path.points.clear();
  for (const Vec2& point : plan.path) static_cast<void>(path.points.push_back(in_mm(point)));  // as many as there fit
}

}  // namespace jaywalk
