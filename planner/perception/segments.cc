#include "planner/perception/segments.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kJumpM = 0.12;     // surfaces closer than this are one thing: a leg is 0.1 m across
constexpr double kJumpSteps = 3.0;  // or than this many beam spacings: a surface seen at 70 degrees

/// Whether a point and the one after it are one thing.
bool joined(const ScanPoint& before, const ScanPoint& point, const Sweep& sweep) {
  const double jump = std::max(kJumpM, kJumpSteps * point.range_m * std::fabs(sweep.angle_step_rad));
  return distance(before.in_robot, point.in_robot) <= jump;
}

}  // namespace

void begin_at_a_jump(const Sweep& sweep, ScanPoints& points) noexcept {
  if (!sweep.all_round || points.empty() || !joined(points.back(), points[0], sweep)) return;
  std::size_t k = 1;
  while (k < points.size() && joined(points[k - 1], points[k], sweep)) ++k;
  std::rotate(points.begin(), points.begin() + k, points.end());
}

void cut_at_jumps(const ScanPoints& points, const Sweep& sweep, Segments& out) noexcept {
  out.clear();
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (k > 0 && joined(points[k - 1], points[k], sweep)) {
      out.back().last = k;
    } else if (!out.push_back({k, k})) {
      return;
    }
  }
}

}  // namespace jaywalk
