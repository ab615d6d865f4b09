#include "planner/localization/scan_matcher.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

using Sample = ScanMatcher::Sample;

constexpr double kCoarseM = 0.1;      // a cell; then half of it
constexpr double kCoarseRad = 0.035;  // two degrees: a cell at 3 m; then half of it
constexpr double kMostWindowM = 0.4, kMostWindowRad = 0.42;
constexpr int kUnknownWorth = EvidenceMap::kMax / 2;  // of a point in unknown space: were it nothing, a robot that
                                                      // drives on would seem to stay where its walls are known
constexpr double kWindowSigmas = 3.0;
constexpr double kThreeSigmaPrice = 0.10;  // a pose three sigma out must put this share more on walls

constexpr std::uint32_t kFewestOnWalls = 25;
constexpr double kLeastShare = 0.4;  // of the points that do not lie in unknown space
constexpr int kMostIterations = 10;
constexpr double kNearM = 0.3;  // a wall's points about a scan's point
constexpr double kThinWallM =
    0.06;  // standard deviation across: a wall seen with 5 cm of noise; thicker things have no direction
constexpr double kPointStdM = 0.02;   // range noise and the map's own roughness
constexpr double kDoubtM = 0.08;      // residuals beyond count less and less
constexpr double kIndependent = 0.1;  // share of points whose errors are their own: neighbours share the map's

/// One hit is enough to be matched against: at the start, and where walls come into view, there is no more.
bool has_surface(const EvidenceMap& still, CellIndex cell) { return still.evidence(cell) > 0; }

/// A straight piece of wall: a point on it and its unit normal.
struct WallPiece {
  Vec2 point, normal;
  double variance = 0.0;  ///< across
};

/// Fits a line to the surface points within kNearM of the one nearest to `p`; false where there is no such line.
bool wall_near(const EvidenceMap& still, Vec2 p, WallPiece& out) {
  const CellIndex cell = still.cell_at(p);
  double nearest = kNearM;
  Vec2 anchor;
  bool any = false;
  for (std::int32_t j = -1; j <= 1; ++j) {
    for (std::int32_t i = -1; i <= 1; ++i) {
      const CellIndex c{cell.i + i, cell.j + j};
      if (!has_surface(still, c)) continue;
      const Vec2 s = still.surface(c);
      const double d = distance(s, p);
      if (d < nearest) nearest = d, anchor = s, any = true;
    }
  }
  if (!any) return false;
  const CellIndex middle = still.cell_at(anchor);
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (std::int32_t j = -3; j <= 3; ++j) {
    for (std::int32_t i = -3; i <= 3; ++i) {
      const CellIndex c{middle.i + i, middle.j + j};
      if (!has_surface(still, c)) continue;
      const Vec2 d = still.surface(c) - anchor;
      if (dot(d, d) > kNearM * kNearM) continue;
      n += 1.0, sx += d.x, sy += d.y, sxx += d.x * d.x, sxy += d.x * d.y, syy += d.y * d.y;
    }
  }
  if (n < 2.0) return false;
  const Vec2 mean{sx / n, sy / n};
  const double cxx = sxx / n - mean.x * mean.x, cxy = sxy / n - mean.x * mean.y, cyy = syy / n - mean.y * mean.y;
  const double half_spread = std::sqrt(0.25 * (cxx - cyy) * (cxx - cyy) + cxy * cxy);
  const double across = std::max(0.0, 0.5 * (cxx + cyy) - half_spread), along = 0.5 * (cxx + cyy) + half_spread;
  if (across > kThinWallM * kThinWallM || along < 4.0 * across) return false;
  // The eigenvector of the smaller eigenvalue, from the longer of the matrix's two rows.
  Vec2 normal = cxx < cyy ? Vec2{across - cyy, cxy} : Vec2{cxy, across - cxx};
  const double length = norm(normal);
  if (!(length > 0.0)) return false;
  out = {anchor + mean, normal * (1.0 / length), across + kPointStdM * kPointStdM};
  return true;
}

/// Share of every `stride`-th point that lies on walls, each weighed by how sure the map is of the wall.
double share_on_walls(const Sample& sample, const EvidenceMap& still, const Pose2& pose, std::size_t stride) {
  const Transform2 to_map(pose);
  int sum = 0, count = 0;
  for (std::size_t k = 0; k < sample.size(); k += stride, ++count) {
    const int evidence = still.evidence(still.cell_at(to_map * sample[k]));
    sum += evidence == 0 ? kUnknownWorth : std::max(0, evidence);
  }
  return static_cast<double>(sum) / (EvidenceMap::kMax * std::max(1, count));
}

Row3 offset(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.heading - from.heading)};
}

Pose2 moved(const Pose2& pose, const Row3& by) {
  return {pose.x + by.x, pose.y + by.y, wrap_angle(pose.heading + by.heading)};
}

}  // namespace

void ScanMatcher::sample(const ScanPoints& scan) noexcept {
  sample_.clear();
  const std::size_t stride = scan.size() / kMostPoints + 1;
  for (std::size_t k = 0; k < scan.size(); k += stride) (void)sample_.push_back(scan[k].in_robot);
}

namespace {

/// Poses on a lattice about `centre`: `reach` steps to each side.
struct Lattice {
  Row3 centre;  ///< from the prediction
  double step_m = 0.0, step_rad = 0.0;
  int reach = 0, reach_heading = 0;
  std::size_t stride = 1;  ///< of the points that are asked
};

/// The best offset from the prediction on the lattice.
Row3 best_on(const Lattice& lattice, const Sample& sample, const EvidenceMap& still, const Pose2& predicted,
             const Symmetric3& information) {
  Row3 best = lattice.centre;
  double best_worth = -1e9;
  for (int h = -lattice.reach_heading; h <= lattice.reach_heading; ++h) {
    for (int y = -lattice.reach; y <= lattice.reach; ++y) {
      for (int x = -lattice.reach; x <= lattice.reach; ++x) {
        const Row3 by{lattice.centre.x + x * lattice.step_m, lattice.centre.y + y * lattice.step_m,
                      lattice.centre.heading + h * lattice.step_rad};
        const double price = kThreeSigmaPrice / 9.0 * information.quadratic(by);
        const double worth = share_on_walls(sample, still, moved(predicted, by), lattice.stride) - price;
        if (worth > best_worth) best_worth = worth, best = by;
      }
    }
  }
  return best;
}

int steps(double variance, double most, double step) {
  return static_cast<int>(std::ceil(std::min(kWindowSigmas * std::sqrt(variance), most) / step));
}

Pose2 search(const Sample& sample, const EvidenceMap& still, const PoseBelief& predicted,
             const Symmetric3& information) {
  const Symmetric3& p = predicted.covariance;
  const Lattice coarse{.centre = {},
                       .step_m = kCoarseM,
                       .step_rad = kCoarseRad,
                       .reach = steps(std::max(p.xx, p.yy), kMostWindowM, kCoarseM),
                       .reach_heading = steps(p.hh, kMostWindowRad, kCoarseRad),
                       .stride = 3};
  const Row3 valley = best_on(coarse, sample, still, predicted.map_from_robot, information);
  const Lattice fine{.centre = valley,
                     .step_m = kCoarseM / 2,
                     .step_rad = kCoarseRad / 2,
                     .reach = 1,
                     .reach_heading = 1,
                     .stride = 1};
  return moved(predicted.map_from_robot, best_on(fine, sample, still, predicted.map_from_robot, information));
}

struct Pull {
  Symmetric3 information;
  Row3 gradient;
  std::uint32_t on_walls = 0, in_the_open = 0;
};

Pull pull_of_walls(const Sample& sample, const EvidenceMap& still, const Pose2& pose) {
  Pull pull;
  const Transform2 to_map(pose);
  for (const Vec2& q : sample) {
    const Vec2 p = to_map * q;
    WallPiece wall;
    if (!wall_near(still, p, wall)) {
      pull.in_the_open += still.seen_free(still.cell_at(p)) ? 1U : 0U;
      continue;
    }
    pull.on_walls += 1;
    const double r = dot(wall.normal, p - wall.point);
    const Row3 jacobian{wall.normal.x, wall.normal.y, cross(p - pose.position(), wall.normal)};
    const double doubt = 1.0 + r * r / (kDoubtM * kDoubtM);
    const double weight = kIndependent / (wall.variance * doubt * doubt);
    pull.information.add_outer(jacobian, weight);
    pull.gradient.x += weight * r * jacobian.x;
    pull.gradient.y += weight * r * jacobian.y;
    pull.gradient.heading += weight * r * jacobian.heading;
  }
  return pull;
}

bool enough(const Pull& pull) {
  const double known = pull.on_walls + pull.in_the_open;
  return pull.on_walls >= kFewestOnWalls && pull.on_walls >= kLeastShare * known;
}

}  // namespace

MatchResult ScanMatcher::match(const ScanPoints& scan, const EvidenceMap& still, const PoseBelief& predicted) noexcept {
  MatchResult result{.belief = predicted};
  sample(scan);
  result.points_used = static_cast<std::uint32_t>(sample_.size());
  if (sample_.size() < kFewestOnWalls) return result;
  const Symmetric3 prior = inverse(predicted.covariance);
  Pose2 pose = search(sample_, still, predicted, prior);
  Symmetric3 posterior;
  for (int k = 0; k < kMostIterations; ++k) {
    const Pull pull = pull_of_walls(sample_, still, pose);
    result.points_on_walls = pull.on_walls;
    if (!enough(pull)) return result;
    const Row3 from_prior = prior * offset(predicted.map_from_robot, pose);
    posterior = inverse(prior + pull.information);
    const Row3 step = posterior * Row3{pull.gradient.x + from_prior.x, pull.gradient.y + from_prior.y,
                                       pull.gradient.heading + from_prior.heading};
    pose = moved(pose, {-step.x, -step.y, -step.heading});
    if (std::fabs(step.x) + std::fabs(step.y) + std::fabs(step.heading) < 1e-4) break;
  }
  result.matched = true;
  result.belief = {pose, posterior};
  return result;
}

}  // namespace jaywalk
