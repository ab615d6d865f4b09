#pragma once
// The motions of a commissioning run: each wheel a little forward and back, the other one at rest.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "drivers/wired_drive.h"
#include "hal/hal.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// One wheel turned by itself, and what drive and scanners said at rest before and after.
struct Nudge {
  std::size_t side = 0;  ///< 0: left
  double sign = 1.0;     ///< +1: commanded forward
  WheelState before{}, after{};
  std::vector<LaserScan> scans_before{}, scans_after{};  ///< of each scanner
  bool disobeyed = false;                                ///< the feedback was not what was commanded: it was broken off
  double response_s = 0.0;  ///< by which the feedback followed the commands, of all nudges so far; 0: not known
};

struct NudgeSetup {
  RobotModel model;
  Duration tick = std::chrono::milliseconds(20);
  double speed_mps = 0.1;  ///< at the rim
  double way_m = 0.12;     ///< of the rim, by the wheel's own feedback
};

/// Turns the wheels of drives that are armed: left forward and back, right forward and back, with the stop zone in
/// force for whatever direction wrong wiring may make of it. `lasers`: the model's, in its order. Ends early after a
/// disobedient wheel. Throws StartupError where there is no room, the drives are in trouble, scans or feedback stop
/// coming, or `stopped` says so; the wheels are commanded to rest before.
[[nodiscard]] std::vector<Nudge> nudge_wheels(const NudgeSetup& setup, WiredDrive& drive,
                                              std::span<LaserScanner* const> lasers, Clock& clock,
                                              const std::function<bool()>& stopped);

}  // namespace jaywalk
