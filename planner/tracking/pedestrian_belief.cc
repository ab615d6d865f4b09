#include "planner/tracking/pedestrian_belief.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/detection.h"

namespace jaywalk {
namespace {
constexpr double kViewRad = 0.7;  // so far apart two views are independent
constexpr double kViewS = 3.0;    // from the first look on: all that time alone tells is one view
// ln P(view | pedestrian) / P(view | thing): legs hide one another in a third of all views.
constexpr double kTwoLegs = 1.3, kNoLegs = -0.9;
constexpr double kLegAcrossM = 0.2, kBodyAcrossM = 0.7;
constexpr double kBeamsApartM = 0.06;  // farther off a gap between legs does not show

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
    const bool in_a_gap = ends.low == End::kHidden && ends.high == End::kHidden;  // wall, between two legs
    thin += in_a_gap ? 0 : 1;
    whole += ends.seen() ? 1 : 0;
  }
  if (whole == 0 || (thin == 2 && whole == 1)) return std::nullopt;  // one leg half behind the other, or behind much
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
