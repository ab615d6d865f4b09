#include "planner/localization/scan_matcher.h"

#include <cmath>

#include "planner/localization/wall_piece.h"

namespace jaywalk {
namespace {

// Among people or at the edge of its reach a laser sees no more of walls than this. By trial: 25 loses 13 of 56 drives
// with a laser of 5.6 m, 15 loses 12, 10 loses 11 (docs/tracking-findings.md, "People in view").
constexpr std::uint32_t kFewestOnWalls = 15;
constexpr double kLeastShare = 0.4;  // of the points that do not lie in unknown space
constexpr int kMostIterations = 10;
constexpr double kDoubtM = 0.08;  // residuals beyond count less and less
// Share of points whose errors are their own: neighbours share the map's. By trial (docs/tracking-findings.md).
constexpr double kIndependent = 0.06;

}  // namespace

void ScanMatcher::sample(const ScanPoints& scan) noexcept {
  sample_.clear();
  const std::size_t stride = (scan.size() + kMostMatchPoints - 1) / kMostMatchPoints;
  for (std::size_t k = 0; k < scan.size(); k += stride) (void)sample_.push_back(scan[k].in_robot);
}

namespace {

struct Pull {
  Symmetric3 information;
  Row3 gradient;
  std::uint32_t on_walls = 0, on_standing = 0, in_the_open = 0;
  double fit = 0.0;  ///< a point that lies on its wall adds one
};

Pull pull_of_walls(const MatchSample& sample, const EvidenceMap& still, const Pose2& pose) {
  Pull pull;
  const Transform2 to_map(pose);
  for (const Vec2& q : sample) {
    const Vec2 p = to_map * q;
    WallPiece wall;
    if (!wall_near(still, p, pose.position(), wall)) {
      pull.in_the_open += still.seen_free(still.cell_at(p)) ? 1U : 0U;
      continue;
    }
    pull.on_walls += 1;
    pull.on_standing += wall.stands ? 1U : 0U;
    const double r = dot(wall.normal, p - wall.point);
    const Row3 jacobian{wall.normal.x, wall.normal.y, cross(p - pose.position(), wall.normal)};
    const double doubt = 1.0 + r * r / (kDoubtM * kDoubtM);
    pull.fit += 1.0 / doubt;
    const double weight = kIndependent / (wall.variance * doubt * doubt);
    pull.information.add_outer(jacobian, weight);
    pull.gradient.x += weight * r * jacobian.x;
    pull.gradient.y += weight * r * jacobian.y;
    pull.gradient.heading += weight * r * jacobian.heading;
  }
  return pull;
}

/// Points of which the map knows what is there.
std::uint32_t known(const Pull& pull) { return pull.on_walls + pull.in_the_open; }

bool enough(const Pull& pull) { return pull.on_walls >= kFewestOnWalls && pull.on_walls >= kLeastShare * known(pull); }

bool contradicted(const Pull& pull) {
  return kLeastShare * known(pull) >= kFewestOnWalls && pull.on_walls < kLeastShare * known(pull);
}

}  // namespace

MatchResult ScanMatcher::match(const ScanPoints& scan, const EvidenceMap& still, const PoseBelief& predicted) noexcept {
  MatchResult result{.belief = predicted};
  sample(scan);
  result.points_used = static_cast<std::uint32_t>(sample_.size());
  if (sample_.size() < kFewestOnWalls) return result;
  const Symmetric3 prior = inverse(predicted.covariance);
  Pose2 pose = search_about(predicted, prior, sample_, still);
  Symmetric3 posterior;
  for (int k = 0; k < kMostIterations; ++k) {
    const Pull pull = pull_of_walls(sample_, still, pose);
    result.known_for_long = pull.on_standing >= kFewestOnWalls;
    result.contradicted = contradicted(pull);
    if (!enough(pull)) return result;
    result.fit = pull.fit / known(pull);
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
