#pragma once
#include <cstddef>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {
/// Most tracks kept at once. When full, the newcomer or the farthest from the robot goes; what is wall as well, first.
inline constexpr std::size_t kMaxTracks = 64;

/// Covariance of (position, velocity) along either axis; x and y are alike and independent because
/// process and measurement noise are isotropic. Units m^2, m^2/s, m^2/s^2.
struct AxisCovariance {
  double pp = 0.0;
  double pv = 0.0;
  double vv = 0.0;
};

/// Something that may move, as the controller believes it to be at `stamp`.
struct Track {
  std::uint32_t id = 0;        ///< from 1, never reused in a run
  Time stamp = kNever;         ///< when position and velocity hold
  Vec2 position_in_map;        ///< m, of the body's centre
  Vec2 velocity_in_map;        ///< m/s
  AxisCovariance covariance;   ///< of a published track honest: its middle lies within, whatever its radius
  double radius_m = 0.0;       ///< of the body
  bool moving = false;         ///< moving beyond reasonable doubt
  bool is_pedestrian = false;  ///< more likely than not (PedestrianBelief), or one is known to stand where it is
  Time still_since = kNever;   ///< since when it has stayed within kStandsWithinM; kNever: not published yet
  std::uint32_t hits = 0;      ///< scans that saw it
  Time last_seen = kNever;
  /// Normalised innovation squared of the last detection: how far it was from where it was expected, over the variance.
  /// Chi-squared with two degrees of freedom, 2 on average, where the covariance is honest.
  double nis = 0.0;
};

}  // namespace jaywalk
