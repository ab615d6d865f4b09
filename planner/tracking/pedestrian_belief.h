#pragma once
// Pedestrian belief: log-odds that a standing obstacle is a pedestrian, updated by every new view of it.
#include <optional>

#include "hal/types/geometry.h"
#include "hal/types/time.h"
#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
/// Widest obstacle that may be a pedestrian's body, m across: shoulders, and a bag or a coat. No data on its choice.
inline constexpr double kBodyAcrossM = 0.7;

/// Tells whether a scan shows exactly two obstacles as thin as legs within half a stride of a place in the map. Returns
/// nothing where the scan cannot tell: a leg is half hidden, the obstacle is as wide as a body, or beams lie too far
/// apart.
[[nodiscard]] std::optional<bool> two_legs_at(Vec2 place_in_map, const ScanPoints& points, const PointsInMap& in_map,
                                              const Segments& segments, const Sweep& sweep) noexcept;

/// Log-odds, by Bayes' rule, that an obstacle is a pedestrian. Scans of a standing obstacle from one place repeat the
/// same evidence, so a view counts by the change of its bearing, and once more by time in the first seconds.
class PedestrianBelief {
 public:
  /// Weight of another view, in independent views, 0 to 1. `bearing_rad`: direction from the obstacle to the laser, in
  /// the map.
  [[nodiscard]] double new_views(double bearing_rad, Time now) const noexcept;
  /// Adds a view that shows two legs (two_legs_at), or none.
  void look(bool two_legs, double bearing_rad, Time now) noexcept;
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
