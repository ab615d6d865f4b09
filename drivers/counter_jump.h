#pragma once
#include <algorithm>
#include <cmath>

namespace jaywalk {

/// True where a wheel's counter jumped, by a restart or a slip: the difference is no way.
///
/// `turned_rad` since the position before, `since_s` ago, of a wheel that turns with `speed_radps`. Allowed beyond what
/// the speed explains: some steps of the coarsest counter (six Hall states an electrical turn), the way that a wheel
/// gains with 20 rad/s2, as hard a stop as drives are set to, and 20 ms by which speed and position are measured apart.
[[nodiscard]] inline bool jumps(double turned_rad, double speed_radps, double since_s) noexcept {
  constexpr double kSteps_rad = 0.05, kHardest_radps2 = 20.0, kApart_s = 0.02;
  const double explained_rad = speed_radps * (since_s + kApart_s);
  const double nearest_rad = std::clamp(turned_rad, std::min(explained_rad, 0.0), std::max(explained_rad, 0.0));
  return !(std::fabs(turned_rad - nearest_rad) <= kSteps_rad + 0.5 * kHardest_radps2 * since_s * since_s);
}

}  // namespace jaywalk
