#pragma once
#include <filesystem>
#include <string>

#include "apps/campaign/campaign.h"

namespace jaywalk::campaign {

/// Above every model's comfort and below every model's braking; changes are taken over 0.1 s, as Smoothness does.
inline constexpr double kHardBrake_mps2 = 0.7;

/// How a passenger is driven, from robot.csv.
struct Ride {
  double steering_reversals = 0.0;  ///< how often the robot turned one way, and then the other
  double speed_reversals = 0.0;     ///< how often it drove one way, and then the other
  double stood_share = 0.0;         ///< of its ticks: slower than 0.05 m/s
  double hard_brakes = 0.0;         ///< how often it slowed down by more than kHardBrake_mps2
  double calm_jerk_p99_mps3 = 0.0;  ///< 99th percentile of the jerk without them; NaN where nothing is left
};

/// Throws StartupError where there is no such table.
[[nodiscard]] Ride ride_of(const std::filesystem::path& robot_csv);

struct FailureWords {
  double at_s = 0.0;   ///< the decisive moment
  std::string reason;  ///< "mover 7 had to turn: ..."
};

/// Why the run in `folder` came to `outcome`, which is no success, from its tables. Throws StartupError where they are
/// not there.
[[nodiscard]] FailureWords failure_words(const PlannedRun& run, const std::string& outcome,
                                         const std::filesystem::path& folder);

}  // namespace jaywalk::campaign
