#include "apps/setup/scan_shift.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/setup/scan_surfels.h"

namespace jaywalk {
namespace {

constexpr double kWidest_rad = 1.2, kStep_rad = 0.1;
/// A nudge is short, whatever the mount: it weighs as two points at rest, and half a metre is a wrong match.
constexpr double kRestPoints = 2.0, kMost_m = 0.5;
constexpr double kMostLeft_m = 0.05;

}  // namespace

std::optional<ScanShift> match_scans(const LaserScan& before, const LaserScan& after) {
  const std::vector<Surfel> walls = surfels_of(before), points = surfels_of(after);
  if (walls.size() < kLeastSurfels || points.size() < kLeastSurfels) return std::nullopt;
  SurfelFit best;
  for (double turn = -kWidest_rad; turn <= kWidest_rad + 1e-9; turn += kStep_rad) {
    const SurfelFit fit = fit_surfels({0.0, 0.0, turn}, walls, points, kRestPoints);
    if (fit.left_m < best.left_m && norm(fit.before_from_after.position()) < kMost_m) best = fit;
  }
  if (best.left_m > kMostLeft_m || best.across < kLeastAcross) return std::nullopt;
  return ScanShift{best.before_from_after, best.left_m};
}

double misfit_m(const LaserScan& before, const LaserScan& after, const Pose2& before_from_after) {
  constexpr double kMostOff_m = 0.1;
  const std::vector<Surfel> walls = surfels_of(before), points = surfels_of(after);
  if (walls.empty() || points.empty()) return kMostOff_m;
  const Transform2 to_before(before_from_after);
  double sum_m = 0.0;
  for (const Surfel& surfel : points) {
    const Surfel& wall = nearest(walls, to_before * surfel.at);
    const bool alike = are_alike(wall.normal, to_before.rotate(surfel.normal));
    const double off_m = std::fabs(dot(wall.normal, to_before * surfel.at - wall.at));
    sum_m += alike ? std::min(off_m, kMostOff_m) : kMostOff_m;
  }
  return sum_m / static_cast<double>(points.size());
}

}  // namespace jaywalk
