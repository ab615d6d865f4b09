#include "planner/scan/segments.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kJumpM = 0.12;     // surfaces closer than this are one thing: a leg is 0.1 m across
constexpr double kJumpSteps = 3.0;  // or than this many beam spacings: a surface seen at 70 degrees
// At a greater slant: the steps on both sides of the jump go within 18 degrees of it and are a third as long at least,
// which ranges noisy by a centimetre keep to. 0.9 to 0.97 and 2 to 3 told nothing apart.
constexpr double kSameWay = 0.95, kLongestJump = 3.0;

/// From point `k` to the next, round the list's end.
Vec2 step_from(const ScanPoints& points, std::size_t k) {
  const std::size_t n = points.size();
  return points[(k + 1) % n].in_robot - points[k % n].in_robot;
}

bool goes_on_as(Vec2 step, Vec2 jump) {
  return dot(step, jump) > kSameWay * norm(step) * norm(jump) && norm(jump) < kLongestJump * norm(step);
}

/// Whether point `k` and the next are one thing: near each other, or of one straight surface seen at a slant.
bool joined(const ScanPoints& points, std::size_t k, const Sweep& sweep) {
  const std::size_t n = points.size();
  const Vec2 jump = step_from(points, k);
  const double farther_m = std::max(points[k].range_m, points[(k + 1) % n].range_m);  // whichever way it turns
  const double spacing_m = farther_m * std::fabs(sweep.angle_step_rad);
  if (norm(jump) <= std::max(kJumpM, kJumpSteps * spacing_m)) return true;
  const bool at_an_end = !sweep.all_round && (k == 0 || k + 2 >= n);
  return !at_an_end && goes_on_as(step_from(points, k + n - 1), jump) && goes_on_as(step_from(points, k + 1), jump);
}

}  // namespace

void begin_at_a_jump(const Sweep& sweep, ScanPoints& points) noexcept {
  if (!sweep.all_round || points.empty() || !joined(points, points.size() - 1, sweep)) return;
  std::size_t k = 1;
  while (k < points.size() && joined(points, k - 1, sweep)) ++k;
  std::rotate(points.begin(), points.begin() + k, points.end());
}

void cut_at_jumps(const ScanPoints& points, const Sweep& sweep, Segments& out) noexcept {
  out.clear();
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (k > 0 && joined(points, k - 1, sweep)) {
      out.back().last = k;
    } else {
      (void)out.push_back({k, k});  // never full
    }
  }
}

}  // namespace jaywalk
