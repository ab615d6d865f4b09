#pragma once
// Straight walks of constant speed, fitted to where a target was seen, and how far they are to be believed.
#include <array>
#include <chrono>
#include <cstddef>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {
struct Target;

/// How well some of a target's last positions lie on one straight walk of constant speed.
struct StraightFit {
  std::size_t positions = 0;
  std::size_t whole_positions = 0;  ///< those at which it was seen whole
  double length_m = 0.0;            ///< of the fitted walk, from the oldest position to the newest
  double duration_s = 0.0;          ///< from the oldest position to the newest
  double longest_hop_m = 0.0;       ///< of the steps between them, what is beyond a walker's at 1.5 m/s
  double sigmas = 0.0;              ///< length over its own standard deviation, by the scatter about the walk
  double width_change_m = 0.0;      ///< widest less narrowest of the positions where it was seen whole
  double spacing_m = 0.0;           ///< from beam to beam, across them, at most: widths are known to that
  double explained = 0.0;           ///< share of the scatter that the walk explains, in [0, 1]; 0: nothing to explain
};

/// Where a target was seen in the last kRemembers, unfiltered. A filter follows whatever it is fed; the positions
/// themselves tell a walk from a detection that hops between the legs of two chairs: of one hop in the middle, a
/// straight walk explains 75 %.
class PositionHistory {
 public:
  /// What a scan saw.
  struct Sample {
    Vec2 where_in_map;
    double width_m = 0.0;    ///< of what was seen
    double spacing_m = 0.0;  ///< from beam to beam, across them
    bool whole = false;      ///< that was all of it
  };

  void add(Time when, const Sample& seen) noexcept;
  /// All positions were `by_m` from where they were taken to be.
  void move(Vec2 by_m) noexcept {
    for (Position& position : positions_) position.seen.where_in_map = position.seen.where_in_map + by_m;
  }
  void clear() noexcept { count_ = 0; }
  /// Least squares over the remembered positions, x and y against time.
  [[nodiscard]] StraightFit fit() const noexcept;
  /// The same over as many of the newest positions, `fewest` at least, as make the walk longest in standard deviations:
  /// a target that stood until just now has walked only since. With fewer positions an empty fit.
  [[nodiscard]] StraightFit fit_newest(std::size_t fewest) const noexcept;

  static constexpr Duration kRemembers = std::chrono::milliseconds(1500);
  static constexpr Duration kApart = std::chrono::milliseconds(60);  ///< nearer in time they are one, their mean

 private:
  struct Position {
    Time since = kNever, when = kNever;  ///< first of its samples, mean of them
    Sample seen;                         ///< mean of where, and the newest
    int scans = 0;
  };
  class Fit;
  static constexpr std::size_t kPositions = kRemembers / kApart + 1;

  [[nodiscard]] const Position& at(std::size_t k) const { return positions_[k % kPositions]; }
  /// The oldest that is not forgotten.
  [[nodiscard]] std::size_t first() const noexcept;

  std::array<Position, kPositions> positions_{};
  std::size_t count_ = 0;  ///< ever added
};

/// A straight walk explains so much of its positions' scatter; one hop in the middle reaches 0.75.
inline constexpr double kStraightExplains = 0.8;
/// The shortest steady walk, where nothing more is known.
inline constexpr double kSteadyM = 0.10;
/// Positions at which both sides of a rigid walk must have been seen: of what was seen whole once, the side that came
/// into view seems to go along.
inline constexpr std::size_t kFewestWhole = 4;

/// Whether `fit` is so straight for its length that there is no doubt left (a slow robot is both slow and straight, a
/// person fast and swaying): so many of its standard deviations long that it is a walk, and longer than growing or
/// shrinking explains. The more the target and the ground tell, the shorter it may be.
[[nodiscard]] bool steady(const Target& e, const StraightFit& fit) noexcept;

/// The shortest walk that is steady, m.
[[nodiscard]] double least_steady_m(const Target& e, const StraightFit& fit) noexcept;

/// Whether a width that changed by `change_m` meanwhile is the same, to what a walk so long tells.
[[nodiscard]] bool keeps_its_width(const StraightFit& fit, double change_m) noexcept;

/// Steady, and both sides of a body went along, of which nothing hides either: no surface that comes into view does so.
[[nodiscard]] bool rigid(const Target& e, const StraightFit& fit) noexcept;

}  // namespace jaywalk
