#include "planner/scan/visible_arc.h"

#include <algorithm>
#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk {
namespace {

constexpr double kWidestHalfRad = 0.6, kNarrowestRad = 1e-6;
constexpr int kSteps = 4;  // of the fixed point: a millimetre of a disc of 0.5 m at 1 m

double asin(double x) {
  x = std::clamp(x, -1.0, 1.0);
  return atan2(x, std::sqrt(1.0 - x * x));
}

/// F of the header, of a disc that is `s` of its centre's range in radius.
double sum_up_to(double t, double s) {
  const double u = sin(t);
  return 0.5 * (t + u * cos(t) - u * std::sqrt(std::max(0.0, s * s - u * u)) - s * s * asin(u / s));
}

/// Mean of the points from `t0` to `t1` along the centre's bearing, as a share of the centre's range.
double mean_share(double t0, double t1, double s) { return (sum_up_to(t1, s) - sum_up_to(t0, s)) / (t1 - t0); }

}  // namespace

SeenDisc seen_disc(double mean_range, double angle) noexcept {
  const double half = std::clamp(0.5 * angle, kNarrowestRad, kWidestHalfRad), s = sin(half);
  const double range = mean_range / mean_share(-half, half, s);
  return {range, range * s, half};
}

SeenDisc seen_side(double radius, double angle, double mean_range, double mean_bearing) noexcept {
  SeenDisc disc{mean_range + kArcMean * radius, radius, 0.0};
  for (int k = 0; k < kSteps; ++k) {
    const double s = std::min(radius / disc.range_m, sin(kWidestHalfRad)), half = asin(s);
    const double seen = std::clamp(angle, kNarrowestRad, 2.0 * half);
    disc.bearing_rad = half;
    disc.range_m = mean_range * cos(half - mean_bearing) / mean_share(-half, seen - half, s);
  }
  return disc;
}

}  // namespace jaywalk
