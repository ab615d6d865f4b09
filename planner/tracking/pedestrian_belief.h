#pragma once
// Pedestrian belief: log-odds that a standing obstacle is a pedestrian, updated by every new view of it.
#include <algorithm>
#include <cmath>

#include "hal/types/geometry.h"
#include "hal/types/time.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
/// Log-odds, by Bayes' rule, that an obstacle is a pedestrian. Scans of a standing obstacle from one place repeat the
/// same evidence, so a view counts by the change of its bearing, and once more by time in the first seconds.
class PedestrianBelief {
 public:
  /// Weight of another view, in independent views, 0 to 1. `bearing_rad`: direction from the obstacle to the laser, in
  /// the map.
  [[nodiscard]] double new_views(double bearing_rad, Time now) const noexcept {
    if (looked_ == kNever) return 1.0;
    const double turned_rad = std::fabs(wrap_angle(bearing_rad - bearing_rad_));
    const auto since_first = [&](Time t) { return std::min(to_seconds(t - first_), kViewS); };
    return std::clamp(turned_rad / kViewRad + (since_first(now) - since_first(looked_)) / kViewS, 0.0, 1.0);
  }
  /// Adds a view that shows two legs (two_legs_at), or none.
  void look(bool two_legs, double bearing_rad, Time now) noexcept {
    const double gain = new_views(bearing_rad, now) * (two_legs ? kTwoLegs : kNoLegs);
    const double most = std::max(log_odds_, kMostByLegs), least = std::min(log_odds_, -kMostByLegs);
    log_odds_ = std::clamp(log_odds_ + gain, least, most);
    bearing_rad_ = bearing_rad;
    if (first_ == kNever) first_ = now;
    looked_ = now;
  }
  /// Raises the belief of an obstacle that arrived: beams passed through its place a moment ago.
  void came() noexcept { log_odds_ = log_odds_ > kCame ? log_odds_ : kCame; }
  /// Raises the belief of an obstacle that was seen to walk.
  void walks() noexcept { log_odds_ = kWalks; }
  /// Takes over the higher belief that the same obstacle had before its track was lost.
  void inherit(const PedestrianBelief& before) noexcept {
    if (before.log_odds_ > log_odds_) *this = before;
  }

  [[nodiscard]] bool is_pedestrian() const { return log_odds_ > 0.0; }
  /// More evidence for a pedestrian than against one: worth another view.
  [[nodiscard]] bool may_be_pedestrian() const { return log_odds_ > kPrior; }

 private:
  /// Change of bearing that makes two views independent, rad. By trial: at 0.35 a pedestrian whose legs hide one
  /// another was forgotten (11 touched in 128 passages, seed 331).
  static constexpr double kViewRad = 0.7;
  /// Time from the first view in which time alone adds one view, s. By trial: evidence by time at rest made posts
  /// pedestrians (90 of 100 worlds reached).
  static constexpr double kViewS = 3.0;
  /// Log-likelihood ratio of a view with two legs, ln P(view | pedestrian) / P(view | obstacle). Chosen, not fitted.
  static constexpr double kTwoLegs = 1.3;
  /// Log-likelihood ratio of a view without: legs hide one another in a third of all views. Chosen; at -1.2 as
  /// kViewRad.
  static constexpr double kNoLegs = -0.9;
  // Chosen on `no_people_left` and `no_people_right`, the driving wheelchair's people and `bench/worlds.py passages`,
  // seed 331: docs/explanation/decisions/standing-pedestrians.md.
  static constexpr double kPrior = -1.35;  ///< log-odds before any view: one obstacle of five; a second view decides
  static constexpr double kCame =
      1.5;  ///< least log-odds after an arrival, four to one: some obstacles only came into view
  static constexpr double kWalks = 7.0;  ///< log-odds after walking, a thousand to one: false movers are rare
  static constexpr double kMostByLegs =
      3.0;  ///< most log-odds from views, either way: paired chair legs look like legs

  double log_odds_ = kPrior;
  double bearing_rad_ = 0.0;               ///< direction of the last view
  Time first_ = kNever, looked_ = kNever;  ///< first and last view
};

}  // namespace jaywalk
