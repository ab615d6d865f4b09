#pragma once
// Wheels turned by a program that watches them: for commissioning and calibration.
#include <functional>
#include <span>
#include <vector>

#include "drivers/wired_drive.h"
#include "firmware/robot/preflight.h"
#include "hal/hal.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// Robot with armed drives that a set-up motion moves without the control loop. What it refers to must outlive the
/// motion.
struct ArmedRobot {
  const RobotModel& model;
  DriveBase& drive;
  std::span<LaserScanner* const> lasers;  ///< the model's, in its order
  Clock& clock;
  std::function<bool()> stopped;  ///< says that a person wants it to end
  Duration tick = std::chrono::milliseconds(20);
};

/// One wheel turned by itself, and what drive and scanners said at rest before and after.
struct Nudge {
  std::size_t side = 0;  ///< 0: left
  double sign = 1.0;     ///< +1: commanded forward
  WheelState before{}, after{};
  std::vector<LaserScan> scans_before{}, scans_after{};  ///< of each scanner
  bool disobeyed = false;                                ///< the feedback was not what was commanded: it was broken off
  double response_s = 0.0;  ///< by which the feedback followed the commands, of all nudges so far; 0: not known
};

/// Turns the wheels: left forward and back, right forward and back, each by 12 cm of its rim, with the stop zone in
/// force for whatever direction wrong wiring may make of it. Ends early after a disobedient wheel. Throws StartupError
/// where there is no room, the drives are in trouble, scans or feedback stop coming, or `stopped` says so; the wheels
/// are commanded to rest before.
[[nodiscard]] std::vector<Nudge> nudge_wheels(const ArmedRobot& robot);

/// Judges each drive by its feedback, then what each scanner's scans show of each nudge against it; of several each
/// part begins with the scanner's name. Wirings that look alike are named together.
[[nodiscard]] std::vector<CheckedPart> judge_nudges(const std::vector<Nudge>& nudges, const RobotModel& model);

}  // namespace jaywalk
