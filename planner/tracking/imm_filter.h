#pragma once
// Interacting multiple model filter (Blom and Bar-Shalom 1988) of three modes, weighed by how well each foretold what
// was seen: the target stands, it walks straight on, or it turns, starts or stops.
#include <array>

#include "planner/tracking/track.h"

namespace jaywalk {

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
  void move(Vec2 by_m) noexcept;

  [[nodiscard]] double weight(Mode mode) const { return modes_[mode].weight; }

 private:
  void mix(double dt_s) noexcept;
  void report(Track& track) const noexcept;

  std::array<ModeState, kCount> modes_{};
};

}  // namespace jaywalk
