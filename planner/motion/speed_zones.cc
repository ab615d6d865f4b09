#include "planner/motion/speed_zones.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "planner/motion/twist_ramp.h"

namespace jaywalk::motion {
namespace {

constexpr double kSettled_m = 0.1;  ///< before a zone begins the drives have the last of the ramp behind them

}  // namespace

SpeedZones::SpeedZones(std::span<const MapZone> zones, const RobotModel& model)
    : reach_m_(model.footprint.circumscribed_radius_m() + kZoneMargin_m), max_accel_mps2_(model.limits.max_accel_mps2) {
  std::copy_if(zones.begin(), zones.end(), std::back_inserter(zones_),
               [](const MapZone& zone) { return zone.kind == ZoneKind::kSpeed; });
}

ZoneSpeed SpeedZones::at(Vec2 robot) const noexcept {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  ZoneSpeed least{kAny, kAny};
  for (const MapZone& zone : zones_) {
    const double left_m = signed_distance(zone, robot) - reach_m_;
    if (left_m <= 0.0) least.here_mps = std::min(least.here_mps, zone.speed_mps);
    const double ahead_m = std::max(left_m - kSettled_m, 0.0);
    least.ahead_mps = std::min(least.ahead_mps, slowing_speed(zone.speed_mps, ahead_m, max_accel_mps2_));
  }
  return least;
}

}  // namespace jaywalk::motion
