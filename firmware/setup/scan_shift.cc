#include "firmware/setup/scan_shift.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "planner/localization/pose_belief.h"

namespace jaywalk {
namespace {

constexpr double kWidest_rad = 1.2, kStep_rad = 0.1;
constexpr int kIterations = 25;
constexpr double kFar_m = 0.2, kFirstFar_m = 0.4, kLastFar_m = 0.06;
constexpr double kAlike = 0.8;  ///< cosine between the normals of what may be one surface
/// A nudge is short, whatever the mount: it weighs as two points at rest, and half a metre is a wrong match.
constexpr double kRestPoints = 2.0, kMost_m = 0.5;
constexpr std::size_t kLeastPoints = 40, kMostPoints = 400;
/// Of the points' normals, the mean square across the direction that is seen least: two points in a hundred on a wall
/// across.
constexpr double kLeastAcross = 0.02;
constexpr double kMostLeft_m = 0.05;

/// A point of a surface and the surface's normal there.
struct Surfel {
  Vec2 at, normal;
};

std::vector<Surfel> surfels_of(const LaserScan& scan) {
  std::vector<Surfel> surfels;
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  const std::size_t every = std::max<std::size_t>(1, beams / kMostPoints), beside = std::max<std::size_t>(2, every);
  const auto hit = [&](std::size_t k) { return direction(scan.angle_rad(k)) * static_cast<double>(scan.range_m[k]); };
  for (std::size_t k = beside; k + beside < beams; k += every) {
    if (!scan.is_hit(k - beside) || !scan.is_hit(k) || !scan.is_hit(k + beside)) continue;
    const Vec2 along = hit(k + beside) - hit(k - beside);
    const double length = norm(along), step = std::fabs(static_cast<double>(scan.angle_step_rad));
    if (length < 1e-6 || length > 0.05 + 6.0 * scan.range_m[k] * step * static_cast<double>(2 * beside)) continue;
    surfels.push_back({hit(k), {-along.y / length, along.x / length}});
  }
  return surfels;
}

const Surfel& nearest(const std::vector<Surfel>& surfels, Vec2 p) {
  return *std::min_element(surfels.begin(), surfels.end(), [p](const Surfel& a, const Surfel& b) {
    return dot(a.at - p, a.at - p) < dot(b.at - p, b.at - p);
  });
}

struct Fit {
  Pose2 pose;
  double left_m = kFar_m;
  double across = 0.0;  ///< the mean square of normals in the direction that has least
};

/// The lesser eigenvalue of the normals' mean outer product.
double least_across(const Eigen::Matrix3d& information, double used) {
  const Eigen::Matrix2d normals = information.topLeftCorner<2, 2>();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(normals, Eigen::EigenvaluesOnly).eigenvalues().x() / used;
}

Fit fit_from(Pose2 pose, const std::vector<Surfel>& before, const std::vector<Surfel>& after) {
  Fit fit;
  for (int k = 0; k < kIterations; ++k) {
    const double far_m = std::max(kLastFar_m, kFirstFar_m * (1.0 - 0.06 * k));
    Eigen::Matrix3d information = diagonal(kRestPoints, kRestPoints, 1e-6);
    Eigen::Vector3d gradient(-kRestPoints * pose.x, -kRestPoints * pose.y, 0.0);
    double used = 0.0, off_m = 0.0;
    const Transform2 to_before(pose);
    for (const Surfel& surfel : after) {
      const Vec2 p = to_before * surfel.at;
      const Surfel& wall = nearest(before, p);
      const double off = dot(wall.normal, p - wall.at);
      const bool alike = std::fabs(dot(wall.normal, to_before.rotate(surfel.normal))) > kAlike;
      const bool pairs = alike && std::fabs(off) < far_m && norm(p - wall.at) < kFirstFar_m;
      off_m += pairs ? std::min(std::fabs(off), kFar_m) : kFar_m;
      if (!pairs) continue;
      const Eigen::Vector3d jacobian(wall.normal.x, wall.normal.y, cross(p - pose.position(), wall.normal));
      information += jacobian * jacobian.transpose();
      gradient -= off * jacobian;
      used += 1.0;
    }
    if (used < static_cast<double>(kLeastPoints)) return {};
    const Eigen::Vector3d step = information.ldlt().solve(gradient);
    pose = moved(pose, step);
    fit = {pose, off_m / static_cast<double>(after.size()), least_across(information, used)};
    if (k > 16 && step.cwiseAbs().sum() < 1e-5) break;
  }
  return fit;
}

}  // namespace

std::optional<ScanShift> match_scans(const LaserScan& before, const LaserScan& after) {
  const std::vector<Surfel> walls = surfels_of(before), points = surfels_of(after);
  if (walls.size() < kLeastPoints || points.size() < kLeastPoints) return std::nullopt;
  Fit best;
  for (double turn = -kWidest_rad; turn <= kWidest_rad + 1e-9; turn += kStep_rad) {
    const Fit fit = fit_from({0.0, 0.0, turn}, walls, points);
    if (fit.left_m < best.left_m && norm(fit.pose.position()) < kMost_m) best = fit;
  }
  if (best.left_m > kMostLeft_m || best.across < kLeastAcross) return std::nullopt;
  return ScanShift{best.pose, best.left_m};
}

double misfit_m(const LaserScan& before, const LaserScan& after, const Pose2& before_from_after) {
  constexpr double kMostOff_m = 0.1;
  const std::vector<Surfel> walls = surfels_of(before), points = surfels_of(after);
  if (walls.empty() || points.empty()) return kMostOff_m;
  const Transform2 to_before(before_from_after);
  double sum_m = 0.0;
  for (const Surfel& surfel : points) {
    const Surfel& wall = nearest(walls, to_before * surfel.at);
    const bool alike = std::fabs(dot(wall.normal, to_before.rotate(surfel.normal))) > kAlike;
    const double off_m = std::fabs(dot(wall.normal, to_before * surfel.at - wall.at));
    sum_m += alike ? std::min(off_m, kMostOff_m) : kMostOff_m;
  }
  return sum_m / static_cast<double>(points.size());
}

}  // namespace jaywalk
