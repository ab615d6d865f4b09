#pragma once
// How far, how crooked and how rough a robot drove.
#include <array>
#include <cstdint>
#include <deque>

#include "apps/report/distribution.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

inline constexpr double kTurnStepM = 0.25;
inline constexpr std::size_t kTurnBins = 18;
inline constexpr double kTurnBinDeg = 10.0;

/// Length and turning angles of a driven path.
///
/// A mark is set every kTurnStepM of travel along the path; the turning angle at a mark is the one,
/// in [0, 180] degrees, between the straight lines from the mark before and to the mark after. Bin i
/// of the histogram counts those in [10 i, 10 (i + 1)) degrees, the last one 180 as well.
class PathShape {
 public:
  void add(Vec2 position);
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double max_turn_deg() const { return max_turn_deg_; }
  [[nodiscard]] const std::array<std::uint32_t, kTurnBins>& turn_histogram() const { return histogram_; }

 private:
  void mark(Vec2 position);

  bool begun_ = false;
  Vec2 newest_;
  Vec2 last_mark_;
  double since_mark_m_ = 0.0;  ///< travel from the last mark to `newest_`
  Vec2 last_step_;             ///< from the last mark but one to the last
  bool stepped_ = false;
  double length_m_ = 0.0;
  double max_turn_deg_ = 0.0;
  std::array<std::uint32_t, kTurnBins> histogram_{};
};

/// Acceleration and jerk from samples of speed. Each is the change over the last kWindow, so that a
/// speed that comes in small steps does not read as violent: a(t) = (v(t) - v(t - window)) / window,
/// and jerk likewise from a.
class Smoothness {
 public:
  static constexpr Duration kWindow{100'000'000};

  void add(Time t, double speed_mps);
  /// Greatest magnitude; NaN before the first window is full.
  [[nodiscard]] double accel_max_mps2() const { return accel_.max(); }
  [[nodiscard]] double jerk_quantile_mps3(double share) const { return jerk_.quantile(share); }

 private:
  struct Sample {
    Time t;
    double speed_mps = 0.0;
    double accel_mps2 = 0.0;
    bool has_accel = false;
  };
  std::deque<Sample> samples_;  ///< the first is the youngest that is at least kWindow old
  Distribution accel_, jerk_;
};

}  // namespace jaywalk
