#include "planner/localization/scan_matcher.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "hal/types/fixed_vector.h"

namespace jaywalk {
namespace {
constexpr double kNearM = 0.25;      // a wall's points about a scan's point
constexpr std::int32_t kReach = 3;   // cells to each side that may hold them
constexpr double kThinWallM = 0.06;  // standard deviation across: a wall seen with 5 cm of noise; thicker things have
                                     // no direction
constexpr double kPointStdM = 0.02;  // range noise and the map's own roughness
// A face looked at along itself seems to be seen from a little behind it: the sine of how far, 10 degrees. By trial.
constexpr double kFromBehind = 0.17;

bool has_surface(const EvidenceMap& still, CellIndex cell) { return still.evidence(cell) > 0; }

struct Surface {
  Vec2 at;  ///< from the anchor
  Vec2 to_laser;
};
using Surfaces = FixedVector<Surface, (2 * kReach + 1) * (2 * kReach + 1)>;

/// The cell of the surface point nearest to `p`; false where none is near.
bool anchor_near(const EvidenceMap& still, Vec2 p, CellIndex& anchor) {
  const CellIndex cell = still.cell_at(p);
  double nearest = kNearM;
  bool any = false;
  for (std::int32_t j = -1; j <= 1; ++j) {
    for (std::int32_t i = -1; i <= 1; ++i) {
      const CellIndex c{cell.i + i, cell.j + j};
      if (!has_surface(still, c)) continue;
      const double d = distance(still.surface(c), p);
      if (d < nearest) nearest = d, anchor = c, any = true;
    }
  }
  return any;
}

void surfaces_about(const EvidenceMap& still, Vec2 anchor, Surfaces& out) {
  const CellIndex middle = still.cell_at(anchor);
  for (std::int32_t j = -kReach; j <= kReach; ++j) {
    for (std::int32_t i = -kReach; i <= kReach; ++i) {
      const CellIndex c{middle.i + i, middle.j + j};
      if (!has_surface(still, c)) continue;
      const Vec2 d = still.surface(c) - anchor;
      if (dot(d, d) <= kNearM * kNearM) (void)out.push_back({d, still.to_laser(c)});
    }
  }
}

struct Line {
  Vec2 mean, normal;
  double across = 0.0, along = 0.0;  ///< variances, m^2
  double points = 0.0;
};

/// By their covariance. False for fewer than two, and for those that spread alike all ways.
bool line_through(const Surfaces& surfaces, Line& out) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (const Surface& s : surfaces) {
    const Vec2 d = s.at;
    n += 1.0, sx += d.x, sy += d.y, sxx += d.x * d.x, sxy += d.x * d.y, syy += d.y * d.y;
  }
  if (n < 2.0) return false;
  out.points = n;
  out.mean = {sx / n, sy / n};
  const Vec2& mean = out.mean;
  const double cxx = sxx / n - mean.x * mean.x, cxy = sxy / n - mean.x * mean.y, cyy = syy / n - mean.y * mean.y;
  const double half_spread = std::sqrt(0.25 * (cxx - cyy) * (cxx - cyy) + cxy * cxy);
  out.across = std::max(0.0, 0.5 * (cxx + cyy) - half_spread), out.along = 0.5 * (cxx + cyy) + half_spread;
  // The eigenvector of the smaller eigenvalue, from the longer of the matrix's two rows.
  const Vec2 normal = cxx < cyy ? Vec2{out.across - cyy, cxy} : Vec2{cxy, out.across - cxx};
  const double length = norm(normal);
  if (!(length > 0.0)) return false;
  out.normal = normal * (1.0 / length);
  return true;
}

/// Removes what `is_unwanted`; the order stays.
template <class Items, class IsUnwanted>
void drop(Items& items, const IsUnwanted& is_unwanted) {
  items.truncate(static_cast<std::size_t>(std::remove_if(items.begin(), items.end(), is_unwanted) - items.begin()));
}

constexpr double kBesideM = 0.2;         // a swinging arm or leg, and where the track may be off
constexpr double kLongestAheadS = 0.25;  // a track that is older than two scans says little of where it is

// Among people or at the edge of its reach a laser sees no more of walls than this. By trial: 25 loses 13 of 56 drives
// with a laser of 5.6 m, 15 loses 12, 10 loses 11 (decision localization).
constexpr std::uint32_t kFewestOnWalls = 15;
constexpr double kLeastShare = 0.4;  // of the points that do not lie in unknown space
constexpr int kMostIterations = 10;
constexpr double kMostByErrors = 0.35;  // share of an axis's information, from which on it tells nothing

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_errors = Eigen::Matrix3d::Zero();  ///< of it: expected of errors of the normals alone
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  std::uint32_t on_walls = 0, on_standing = 0, in_the_open = 0;
  double fit = 0.0;  ///< a point that lies on its wall adds one
};

/// How the distance of a point, `arm` from the robot, along `direction` changes with (x, y, heading).
Eigen::Vector3d jacobian_of(Vec2 direction, Vec2 arm) { return {direction.x, direction.y, cross(arm, direction)}; }

NormalEquations normal_equations(const MatchSample& sample, const ScanReference& reference, const Pose2& pose) {
  NormalEquations sum;
  const Transform2 to_map(pose);
  for (const Vec2& q : sample) {
    const Vec2 p = to_map * q;
    LineFeature wall;
    if (!line_feature_near(reference.map, p, pose.position(), wall)) {
      sum.in_the_open += reference.map.seen_free(reference.map.cell_at(p)) ? 1U : 0U;
      continue;
    }
    sum.on_walls += 1;
    sum.on_standing += wall.stands ? 1U : 0U;
    const double r = dot(wall.normal, p - wall.point);
    const Eigen::Vector3d jacobian = jacobian_of(wall.normal, p - pose.position());
    const Eigen::Vector3d along = jacobian_of({-wall.normal.y, wall.normal.x}, p - pose.position());
    const double doubt = 1.0 + r * r / (reference.kernel_m * reference.kernel_m);
    sum.fit += 1.0 / doubt;
    const double weight = reference.independent_share / (wall.variance * doubt * doubt);
    sum.information += weight * jacobian * jacobian.transpose();
    sum.by_errors += weight * wall.normal_var * along * along.transpose();
    sum.gradient += weight * r * jacobian;
  }
  return sum;
}

/// Drops the axes of the information that errors of the normals explain (solution remapping: Zhang, Kaess, Singh 2016;
/// expected errors: Fuller 1987, 1.2). A corridor's walls, fitted to noisy points, seem to tell where along it the
/// robot is, and hold it there against the wheels: 0.3 m too far after 40 m with noise of 3 cm, at a standard deviation
/// of 0.03 m.
void drop_unconstrained(NormalEquations& walls) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(walls.information);
  const Eigen::Matrix3d& v = axes.eigenvectors();
  const Eigen::Vector3d by_errors = (v.transpose() * walls.by_errors * v).diagonal();
  const Eigen::Vector3d kept = (by_errors.array() < kMostByErrors * axes.eigenvalues().array()).cast<double>();
  const Eigen::Matrix3d keep = v * kept.asDiagonal() * v.transpose();
  walls.information = keep * walls.information;
  walls.gradient = keep * walls.gradient;
}

}  // namespace

bool line_feature_near(const EvidenceMap& still, Vec2 p, Vec2 viewer, LineFeature& out) noexcept {
  CellIndex nearest;
  if (!anchor_near(still, p, nearest)) return false;
  const Vec2 anchor = still.surface(nearest);
  Surfaces surfaces;
  surfaces_about(still, anchor, surfaces);
  Line line;
  if (!line_through(surfaces, line)) return false;
  const Vec2 to_viewer = line.normal * (dot(line.normal, viewer - anchor) < 0.0 ? -1.0 : 1.0);
  const std::size_t all = surfaces.size();
  drop(surfaces, [&](const Surface& s) { return !(dot(to_viewer, s.to_laser) > -kFromBehind); });
  if (surfaces.size() < all && !line_through(surfaces, line)) return false;
  if (line.across > kThinWallM * kThinWallM || line.along < 4.0 * line.across) return false;
  const double normal_var = line.across / (std::max(1.0, line.points - 2.0) * line.along);
  out = {anchor + line.mean, line.normal, line.across + kPointStdM * kPointStdM, normal_var, still.stands(nearest)};
  return true;
}

void mask_moving_tracks(std::span<const Track> moving, const Pose2& map_from_robot, Time stamp,
                        ScanPoints& points) noexcept {
  const Pose2 robot_from_map = inverse(map_from_robot);
  for (const Track& walker : moving) {
    const double ahead_s = std::clamp(to_seconds(stamp - walker.stamp), 0.0, kLongestAheadS);
    const Vec2 centre = robot_from_map * (walker.position_in_map + walker.velocity_in_map * ahead_s);
    const double radius_m = walker.radius_m + kBesideM;
    drop(points, [&](const ScanPoint& point) {
      const Vec2 off = point.in_robot - centre;
      return !(dot(off, off) > radius_m * radius_m);
    });
  }
}

MatchResult match_sample(const MatchSample& sample, const ScanReference& reference,
                         const PoseBelief& predicted) noexcept {
  MatchResult result{.belief = predicted};
  result.points_used = static_cast<std::uint32_t>(sample.size());
  if (sample.size() < kFewestOnWalls) return result;
  const Eigen::Matrix3d prior = predicted.covariance.inverse();
  Pose2 pose = correlative_search(predicted, prior, sample, reference);
  Eigen::Matrix3d information;
  for (int k = 0; k < kMostIterations; ++k) {
    NormalEquations walls = normal_equations(sample, reference, pose);
    result.known_for_long = walls.on_standing >= kFewestOnWalls;
    const std::uint32_t known = walls.on_walls + walls.in_the_open;
    const double least = kLeastShare * known;
    result.contradicted = least >= kFewestOnWalls && walls.on_walls < least;
    if (walls.on_walls < kFewestOnWalls || walls.on_walls < least) return result;
    result.fit = walls.fit / known;
    drop_unconstrained(walls);
    information = prior + walls.information;
    const Eigen::Vector3d gradient = walls.gradient + prior * offset(predicted.map_from_robot, pose);
    const Eigen::Vector3d step = information.ldlt().solve(gradient);
    pose = moved(pose, -step);
    if (step.cwiseAbs().sum() < 1e-4) break;
  }
  result.matched = true;
  result.belief = {pose, information.inverse()};
  return result;
}

}  // namespace jaywalk
