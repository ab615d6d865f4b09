#pragma once
#include <array>
#include <chrono>
#include <cstddef>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// How well some of a body's last places lie on one straight walk of constant speed.
struct StraightWalk {
  std::size_t places = 0;
  std::size_t whole_places = 0;  ///< those at which it was seen whole
  double length_m = 0.0;         ///< of the fitted walk, from the oldest place to the newest
  double duration_s = 0.0;       ///< from the oldest place to the newest
  double longest_hop_m = 0.0;    ///< of the steps from place to place, what is beyond a walker's at 1.5 m/s
  double sigmas = 0.0;           ///< length over its own standard deviation, by the places' scatter about the walk
  double width_change_m = 0.0;   ///< widest less narrowest of the places where it was seen whole
  double spacing_m = 0.0;        ///< from beam to beam, across them, at most: widths are known to that
  double explained = 0.0;  ///< share of the places' scatter that the walk explains, in [0, 1]; 0: nothing to explain
};

/// Where a body was seen in the last kRemembers, unfiltered. A filter follows whatever it is fed; the places themselves
/// tell a walk from a cluster that hops between the legs of two chairs: of one hop in the middle, a straight walk
/// explains 75 %.
class RecentPath {
 public:
  /// What a scan saw.
  struct Sighting {
    Vec2 where_in_map;
    double width_m = 0.0;    ///< of what was seen
    double spacing_m = 0.0;  ///< from beam to beam, across them
    bool whole = false;      ///< that was all of it
  };

  void add(Time when, const Sighting& seen) noexcept;
  /// All places were `by_m` from where they were taken to be.
  void move(Vec2 by_m) noexcept;
  void clear() noexcept { count_ = 0; }
  /// Least squares over the remembered places, x and y against time.
  [[nodiscard]] StraightWalk fit() const noexcept;
  /// The same over as many of the newest places, `fewest` at least, as make the walk longest in standard deviations:
  /// who stood until just now has walked only since. Without so many places a walk of none.
  [[nodiscard]] StraightWalk latest_walk(std::size_t fewest) const noexcept;

  static constexpr Duration kRemembers = std::chrono::milliseconds(1500);
  static constexpr Duration kApart = std::chrono::milliseconds(60);  ///< places nearer in time are one, their mean

 private:
  struct Place {
    Time since = kNever, when = kNever;  ///< first of them, mean of them
    Sighting seen;                       ///< mean of where, and the newest
    int scans = 0;
  };
  class Fit;
  static constexpr std::size_t kPlaces = kRemembers / kApart + 1;

  [[nodiscard]] const Place& at(std::size_t k) const { return places_[k % kPlaces]; }
  /// The oldest place that is not forgotten.
  [[nodiscard]] std::size_t first() const noexcept;

  std::array<Place, kPlaces> places_{};
  std::size_t count_ = 0;  ///< ever added
};

}  // namespace jaywalk
