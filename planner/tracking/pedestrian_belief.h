#pragma once
// How likely what stands is a pedestrian: each new view of it adds to that, or takes away.
#include <optional>

#include "hal/types/geometry.h"
#include "hal/types/time.h"
#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
/// Whether a scan shows two legs about a place, in the map: exactly two things as thin as legs, not farther apart than
/// a stride. None where it tells nothing: one of them is half hidden, or as wide as people, or too far off to
/// tell legs apart.
[[nodiscard]] std::optional<bool> two_legs_at(Vec2 place_in_map, const ScanPoints& points, const PointsInMap& in_map,
                                              const Segments& segments, const Sweep& sweep) noexcept;

/// Log-odds that a thing is a pedestrian, by Bayes' rule. Scans from one place, of a thing that stands, say the same
/// again and again: a view counts as far as its bearing has changed, or, in the first seconds, time has passed.
class PedestrianBelief {
 public:
  /// How many independent views another one is, 0 to 1; `bearing_rad`: of the laser from the thing, in the map.
  [[nodiscard]] double new_views(double bearing_rad, Time now) const noexcept;
  /// A scan shows two legs there, or does not.
  void look(bool two_legs, double bearing_rad, Time now) noexcept;
  /// Beams went through its place a moment ago, scan after scan.
  void came() noexcept { log_odds_ = log_odds_ > kCame ? log_odds_ : kCame; }
  /// It was seen to walk.
  void walks() noexcept { log_odds_ = kWalks; }
  /// `before`: of the same thing, before it was followed again.
  void inherit(const PedestrianBelief& before) noexcept {
    if (before.log_odds_ > log_odds_) *this = before;
  }

  [[nodiscard]] bool is_pedestrian() const { return log_odds_ > 0.0; }
  /// More has spoken for it than against.
  [[nodiscard]] bool may_be_pedestrian() const { return log_odds_ > kPrior; }

 private:
  // Chosen on `no_people_left` and `no_people_right`, the driving wheelchair's people and `bench/worlds.py passages`,
  // seed 331: docs/explanation/decisions/standing-pedestrians.md.
  static constexpr double kPrior = -1.35;     ///< one thing of five; a second view decides
  static constexpr double kCame = 1.5;        ///< four to one: some things only came into view
  static constexpr double kWalks = 7.0;       ///< a thousand to one
  static constexpr double kMostByLegs = 3.0;  ///< either way: pairs of chair legs look like legs from anywhere

  double log_odds_ = kPrior;
  double bearing_rad_ = 0.0;  ///< of the last view
  Time first_ = kNever, looked_ = kNever;
};

}  // namespace jaywalk
