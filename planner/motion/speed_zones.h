#pragma once
#include <span>
#include <vector>

#include "hal/types/map_zones.h"
#include "hal/types/robot_model.h"

namespace jaywalk::motion {

/// The fastest that speed zones let the robot drive, m/s; infinity where none says anything.
struct ZoneSpeed {
  double here_mps;   ///< now: the least of the zones that the circle about the body touches
  double ahead_mps;  ///< so that half of the comfortable deceleration slows down before the next zone begins
};

/// Zones in which the robot drives slowly. Memory in the constructor. Thread: any.
class SpeedZones {
 public:
  SpeedZones(std::span<const MapZone> zones, const RobotModel& model);
  [[nodiscard]] ZoneSpeed at(Vec2 robot_in_map) const noexcept;

 private:
  std::vector<MapZone> zones_;  ///< speed zones alone
  double reach_m_;              ///< of the body, and what its pose may be off by
  double max_accel_mps2_;
};

}  // namespace jaywalk::motion
