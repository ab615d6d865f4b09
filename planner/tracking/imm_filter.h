#pragma once
// Interacting multiple model filter (Blom and Bar-Shalom 1988) of three modes, weighed by how well each foretold what
// was seen: the target stands, it walks straight on, or it turns, starts or stops.
#include <array>

#include "planner/tracking/track.h"

namespace jaywalk {
// The Kalman filter of the paper (its equations 12 to 16) for something that moves at constant velocity.
//
// State (position, velocity), A = [1 dt; 0 1], H = [1 0], no input. x and y are alike and independent, so one
// covariance serves both axes. Process noise: white acceleration, constant over a step (the planner's
// predictions, planner/cell/kalman.h, take it as white noise, since walkers do not hold an acceleration for seconds).

/// Eqs. 12 and 13: moves the track `dt_s` >= 0 seconds on. `accel_std_mps2`: what it may accelerate by, an axis.
void predict(Track& track, double dt_s, double accel_std_mps2) noexcept;

/// Eqs. 14 to 16: takes a measured position, of variance `noise_m2` > 0 an axis. Rounding leaves no variance below 0.
void correct(Vec2& position, Vec2& velocity, AxisCovariance& covariance, Vec2 measured, double noise_m2) noexcept;

/// Squared Mahalanobis distance of a position, measured `late_s` after the track's stamp, from the track's then:
/// chi-squared with two degrees of freedom when the measurement is the track's.
[[nodiscard]] double gate_distance2(const Track& track, Vec2 measured_in_map, double std_m,
                                    double late_s = 0.0) noexcept;

/// What one mode believes. x and y are alike and independent, so one covariance serves both axes.
struct ModeState {
  Vec2 position, velocity;
  AxisCovariance covariance;
  double weight = 0.0;  ///< the probability that the target is in this mode
};

class ImmFilter {
 public:
  enum Mode : std::size_t { kStands, kWalks, kTurns, kCount };

  ImmFilter() = default;
  /// At `track`'s place and speed, as doubtful as it is.
  explicit ImmFilter(const Track& track);

  /// Moves every mode `dt_s` >= 0 seconds on, and `track` to their mean.
  void predict(Track& track, double dt_s) noexcept;
  /// Takes a position measured `late_s` after the track's stamp, `std_m` > 0 an axis, and weighs the modes by it;
  /// `track` becomes their mean, at its stamp.
  void correct(Track& track, Vec2 measured_in_map, double std_m, double late_s = 0.0) noexcept;
  /// What was taken for its stamp was `late_s` after it: back to where it was then, going straight.
  void date_back(Track& track, double late_s) noexcept;
  /// Every mode was `by_m` from where it took the target to be.
  void move(Vec2 by_m) noexcept {
    for (ModeState& s : modes_) s.position = s.position + by_m;
  }

  [[nodiscard]] double weight(Mode mode) const { return modes_[mode].weight; }

 private:
  void mix(double dt_s) noexcept;
  void report(Track& track) const noexcept;

  std::array<ModeState, kCount> modes_{};
};

}  // namespace jaywalk
