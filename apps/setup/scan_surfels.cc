#include "apps/setup/scan_surfels.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "planner/localization/pose_belief.h"

namespace jaywalk {
namespace {

constexpr int kFitIterations = 25;
constexpr double kFirstFar_m = 0.4, kLastFar_m = 0.06;
constexpr double kAlike = 0.8;  ///< cosine between the normals of what may be one surface
constexpr std::size_t kMostPoints = 400;

/// The lesser eigenvalue of the normals' mean outer product.
double least_across(const Eigen::Matrix3d& points, double used) {
  const Eigen::Matrix2d normals = points.topLeftCorner<2, 2>();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(normals, Eigen::EigenvaluesOnly).eigenvalues().x() / used;
}

std::vector<Surfel> surfels_of(const LaserScan& scan) {
  return surfels_of(beam_ends(scan), std::fabs(static_cast<double>(scan.angle_step_rad)));
}

/// The one nearest to `p`; there is one.
const Surfel& nearest(const std::vector<Surfel>& surfels, Vec2 p) {
  return *std::ranges::min_element(surfels, {}, [p](const Surfel& each) { return dot(each.at - p, each.at - p); });
}

/// Whether normals are those of what may be one surface, looked at from either side.
bool are_alike(Vec2 normal, Vec2 other) { return std::fabs(dot(normal, other)) > kAlike; }

constexpr double kWidest_rad = 1.2, kStep_rad = 0.1;
/// A nudge is short, whatever the mount: it weighs as two points at rest, and half a metre is a wrong match.
constexpr double kRestPoints = 2.0, kMost_m = 0.5;
constexpr double kMostLeft_m = 0.05;

}  // namespace

BeamEnds beam_ends(const LaserScan& scan) {
  BeamEnds ends(std::min<std::size_t>(scan.beam_count, kMaxBeams));
  for (std::size_t k = 0; k < ends.size(); ++k)
    if (scan.is_hit(k)) ends[k] = direction(scan.angle_rad(k)) * static_cast<double>(scan.range_m[k]);
  return ends;
}

std::vector<Surfel> surfels_of(const BeamEnds& ends, double step_rad) {
  std::vector<Surfel> surfels;
  const std::size_t every = std::max<std::size_t>(1, ends.size() / kMostPoints),
                    beside = std::max<std::size_t>(2, every);
  for (std::size_t k = beside; k + beside < ends.size(); k += every) {
    if (!ends[k - beside] || !ends[k] || !ends[k + beside]) continue;
    const Vec2 along = *ends[k + beside] - *ends[k - beside];
    const double length = norm(along);
    if (length < 1e-6 || length > 0.05 + 6.0 * norm(*ends[k]) * step_rad * static_cast<double>(2 * beside)) continue;
    surfels.push_back({*ends[k], {-along.y / length, along.x / length}});
  }
  return surfels;
}

SurfelFit fit_surfels(const Pose2& guess, const std::vector<Surfel>& before, const std::vector<Surfel>& after,
                      double rest_points) {
  SurfelFit fit;
  Pose2 pose = guess;
  for (int k = 0; k < kFitIterations; ++k) {
    const double far_m = std::max(kLastFar_m, kFirstFar_m * (1.0 - 0.06 * k));
    Eigen::Matrix3d points = diagonal(rest_points, rest_points, 1e-6);
    Eigen::Vector3d gradient(-rest_points * pose.x, -rest_points * pose.y, 0.0);
    double used = 0.0, off_m = 0.0;
    const Transform2 to_before(pose);
    for (const Surfel& surfel : after) {
      const Vec2 p = to_before * surfel.at;
      const Surfel& wall = nearest(before, p);
      const double off = dot(wall.normal, p - wall.at);
      const bool alike = are_alike(wall.normal, to_before.rotate(surfel.normal));
      const bool pairs = alike && std::fabs(off) < far_m && norm(p - wall.at) < kFirstFar_m;
      off_m += pairs ? std::min(std::fabs(off), kFarOff_m) : kFarOff_m;
      if (!pairs) continue;
      const Eigen::Vector3d jacobian(wall.normal.x, wall.normal.y, cross(p - pose.position(), wall.normal));
      points += jacobian * jacobian.transpose();
      gradient -= off * jacobian;
      used += 1.0;
    }
    if (used < static_cast<double>(kLeastSurfels)) return {};
    const Eigen::Vector3d step = points.ldlt().solve(gradient);
    pose = moved(pose, step);
    fit = {pose, off_m / static_cast<double>(after.size()), least_across(points, used), points, used};
    if (k > 16 && step.cwiseAbs().sum() < 1e-5) break;
  }
  return fit;
}

std::optional<Pose2> match_scans(const LaserScan& before, const LaserScan& after) {
  const std::vector<Surfel> walls = surfels_of(before), points = surfels_of(after);
  if (walls.size() < kLeastSurfels || points.size() < kLeastSurfels) return std::nullopt;
  SurfelFit best;
  for (double turn = -kWidest_rad; turn <= kWidest_rad + 1e-9; turn += kStep_rad) {
    const SurfelFit fit = fit_surfels({0.0, 0.0, turn}, walls, points, kRestPoints);
    if (fit.left_m < best.left_m && norm(fit.before_from_after.position()) < kMost_m) best = fit;
  }
  if (best.left_m > kMostLeft_m || best.across < kLeastAcross) return std::nullopt;
  return best.before_from_after;
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
