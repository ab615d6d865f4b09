#pragma once
// The part of a disc that a laser sees: where its centre lies behind the mean of its points.
//
// Beams at equal angles t from the centre's bearing end on a disc of radius r, its centre d away, at the ranges
// d cos t - sqrt(r^2 - d^2 sin^2 t). Their points' mean from t0 to t1, along that bearing, is d (F(t1) - F(t0)) / (t1 -
// t0) with s = r / d and 2 F(t) = t + sin t cos t - sin t sqrt(s^2 - sin^2 t) - s^2 asin(sin t / s).
#include "hal/types/geometry.h"

namespace jaywalk {

/// The mean of the half circle that parallel beams see lies so much of the radius before its centre: a disc far off.
inline constexpr double kArcMean = kPi / 4.0;

/// A disc as a laser sees it.
struct SeenDisc {
  double range_m = 0.0;      ///< of its centre, from the laser
  double radius_m = 0.0;     ///< of the disc
  double bearing_rad = 0.0;  ///< of its centre, from the side that is seen
};

/// The disc that is seen whole, under `angle_rad` > 0 from side to side, its points' mean `mean_range_m` away. Angles
/// beyond 1.2 rad (a disc of 0.5 m at 0.9 m) are taken for that: so near, most things are not round.
[[nodiscard]] SeenDisc seen_disc(double mean_range_m, double angle_rad) noexcept;

/// The disc of `radius_m` that is seen from one side on, over `angle_rad` > 0; its points' mean lies `mean_range_m`
/// away and `mean_bearing_rad` from that side.
[[nodiscard]] SeenDisc seen_side(double radius_m, double angle_rad, double mean_range_m,
                                 double mean_bearing_rad) noexcept;

}  // namespace jaywalk
