#pragma once
#include <filesystem>

namespace jaywalk::campaign {

/// How a passenger is driven, from robot.csv.
struct Ride {
  double steering_reversals = 0.0;  ///< how often the robot turned one way, and then the other
  double speed_reversals = 0.0;     ///< how often it drove one way, and then the other
  double stood_share = 0.0;         ///< of its ticks: slower than 0.05 m/s
};

/// Throws StartupError where there is no such table.
[[nodiscard]] Ride ride_of(const std::filesystem::path& robot_csv);

}  // namespace jaywalk::campaign
