#pragma once
#include <cstddef>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Most tracks kept at once. When full, the newcomer or the farthest from the robot goes; what is wall as well, first.
inline constexpr std::size_t kMaxTracks = 64;

/// Who walked and is slower stands, for now (m/s).
inline constexpr double kStoppedMps = 0.10;

/// Covariance of (position, velocity) along either axis; x and y are alike and independent because
/// process and measurement noise are isotropic. Units m^2, m^2/s, m^2/s^2.
struct AxisCovariance {
  double pp = 0.0;
  double pv = 0.0;
  double vv = 0.0;
};

/// Something that may move, as the controller believes it to be at `stamp`.
struct Track {
  std::uint32_t id = 0;       ///< from 1, never reused in a run
  Time stamp = kNever;        ///< when position and velocity hold
  Vec2 position_in_map;       ///< m, of the body's centre
  Vec2 velocity_in_map;       ///< m/s
  AxisCovariance covariance;  ///< of a published track honest: its middle lies within, whatever its radius
  double radius_m = 0.0;      ///< of the body
  bool moving = false;        ///< moving beyond reasonable doubt
  std::uint32_t hits = 0;     ///< scans that saw it
  Time last_seen = kNever;
  /// The last innovation, squared and over its variance: how far from where it was expected the last scan saw it.
  /// Chi-squared with two degrees of freedom, 2 on average, where the covariance is honest.
  double surprise = 0.0;
};

}  // namespace jaywalk
