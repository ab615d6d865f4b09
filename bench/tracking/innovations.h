#pragma once
// Whether tracks are as sure as they have a right to be (Bar-Shalom et al. 2001, section 5.4).
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>

#include "planner/tracking/track.h"

namespace jaywalk::bench {

inline constexpr double kWithin95 = 5.991;  ///< chi-squared, two degrees of freedom: -2 ln 0.05

/// Innovations of tracks that move, each squared and divided by the covariance that the filter gave it: chi-squared
/// with two degrees of freedom where the filter is honest, mean 2, 95 in 100 below 5.99. Less: it doubts too much.
class Innovations {
 public:
  /// The tracks after each scan, in the order of time. Those that move, were there before and were seen again tell
  /// theirs (Track::surprise).
  void add(std::span<const Track> tracks);

  [[nodiscard]] std::size_t count() const { return count_; }
  /// NaN without any, as the next.
  [[nodiscard]] double mean() const;
  /// How far from 2 the mean of so many independent ones stays in 95 of 100 cases.
  [[nodiscard]] double mean_bound() const;
  [[nodiscard]] double share_within_95() const;

 private:
  std::map<std::uint32_t, std::uint32_t> hits_before_;  ///< of each track
  std::size_t count_ = 0, within_ = 0;
  double sum_ = 0.0;
};

/// Of a simulation's recording, lived through again without plans: seeing does not depend on them. None in mode
/// paper, whose movers come from outside. Throws StartupError.
[[nodiscard]] Innovations innovations_of(const std::filesystem::path& recording);

}  // namespace jaywalk::bench
