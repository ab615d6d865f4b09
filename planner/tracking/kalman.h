#pragma once
// The Kalman filter of the paper (its equations 12 to 16) for something that moves at constant velocity.
//
// State (position, velocity), A = [1 dt; 0 1], H = [1 0], no input. x and y are alike and independent, so one
// covariance serves both axes. Process noise: white acceleration, constant over a step (the planner's
// predictions, planner/cell/kalman.h, take it as white throughout: over seconds nobody holds an acceleration).
#include "planner/tracking/track.h"

namespace jaywalk {

/// Eqs. 12 and 13: moves the track `dt_s` >= 0 seconds on. `accel_std_mps2`: what it may accelerate by, an axis.
void predict(Track& track, double dt_s, double accel_std_mps2) noexcept;

/// Eqs. 14 to 16: takes a measured position, of variance `noise_m2` > 0 an axis. Rounding leaves no variance below 0.
void correct(Vec2& position, Vec2& velocity, AxisCovariance& covariance, Vec2 measured, double noise_m2) noexcept;

/// Squared Mahalanobis distance of a position, measured `late_s` after the track's stamp, from the track's then:
/// chi-squared with two degrees of freedom when the measurement is the track's.
[[nodiscard]] double gate_distance2(const Track& track, Vec2 measured_in_map, double std_m,
                                    double late_s = 0.0) noexcept;

}  // namespace jaywalk
