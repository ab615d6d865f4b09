#include "planner/tracking/pedestrian_belief.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/detection.h"

namespace jaywalk {
namespace {
// Change of bearing that makes two views independent, rad. By trial: at 0.35 a pedestrian whose legs hide one another
// was forgotten (11 touched in 128 passages, seed 331).
constexpr double kViewRad = 0.7;
// Time from the first view in which time alone adds one view, s. By trial: evidence by time at rest made posts
// pedestrians (90 of 100 worlds reached).
constexpr double kViewS = 3.0;
// Log-likelihood ratio of a view with two legs, ln P(view | pedestrian) / P(view | obstacle). Chosen, not fitted.
constexpr double kTwoLegs = 1.3;
// Log-likelihood ratio of a view without: legs hide one another in a third of all views. Chosen; at -1.2 as kViewRad.
constexpr double kNoLegs = -0.9;
// Widest obstacle that may be a leg, m across: at 0.15 six of 103 labels of standing people are lost.
constexpr double kLegAcrossM = 0.2;
// Largest distance from beam to beam that shows the gap between two legs, m. No data on its choice.
constexpr double kBeamsApartM = 0.06;

double away_m(Vec2 place, const PointsInMap& in_map, const Segment& segment) {
  double least_m = distance(in_map.position[segment.first], place);
  for (std::uint32_t k = segment.first + 1; k <= segment.last; ++k)
    least_m = std::min(least_m, distance(in_map.position[k], place));
  return least_m;
}

}  // namespace

std::optional<bool> two_legs_at(Vec2 place, const ScanPoints& points, const PointsInMap& in_map,
                                const Segments& segments, const Sweep& sweep) noexcept {
  int thin = 0, whole = 0;
  for (const Segment& segment : segments) {
    if (points[segment.first].range_m * std::fabs(sweep.angle_step_rad) > kBeamsApartM) continue;
    const double there_m = away_m(place, in_map, segment);
    if (there_m > 0.5 * kStrideM) continue;
    const double width_m = distance(in_map.position[segment.first], in_map.position[segment.last]);
    if (width_m > kLegAcrossM) {
      if (there_m > kLegsReachM) continue;
      if (width_m > kBodyAcrossM) return false;
      return std::nullopt;
    }
    const Ends ends = ends_of(segment, points, sweep);
    const bool in_a_gap = ends.low == End::kHidden && ends.high == End::kHidden;  // a wall behind two legs
    thin += in_a_gap ? 0 : 1;
    whole += ends.seen() ? 1 : 0;
  }
  if (whole == 0 || (thin == 2 && whole == 1)) return std::nullopt;  // a leg is half hidden
  return thin == 2;
}

double PedestrianBelief::new_views(double bearing_rad, Time now) const noexcept {
  if (looked_ == kNever) return 1.0;
  const double turned_rad = std::fabs(wrap_angle(bearing_rad - bearing_rad_));
  const auto since_first = [&](Time t) { return std::min(to_seconds(t - first_), kViewS); };
  return std::clamp(turned_rad / kViewRad + (since_first(now) - since_first(looked_)) / kViewS, 0.0, 1.0);
}

void PedestrianBelief::look(bool two_legs, double bearing_rad, Time now) noexcept {
  const double gain = new_views(bearing_rad, now) * (two_legs ? kTwoLegs : kNoLegs);
  const double most = std::max(log_odds_, kMostByLegs), least = std::min(log_odds_, -kMostByLegs);
  log_odds_ = std::clamp(log_odds_ + gain, least, most);
  bearing_rad_ = bearing_rad;
  if (first_ == kNever) first_ = now;
  looked_ = now;
}

}  // namespace jaywalk
