#pragma once
// Wheels turned by a program that watches them: for commissioning and calibration.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "drivers/wired_drive.h"
#include "firmware/robot/preflight.h"
#include "firmware/safety/felt_motion.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/stop_zone.h"
#include "hal/hal.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

struct WatchedDriveSetup {
  std::string purpose;  ///< "commissioning": how its complaints begin
  RobotModel model;
  Duration tick = std::chrono::milliseconds(20);
};

/// Drives that are armed, a tick at a time. Every complaint is a StartupError, and the wheels are commanded to rest
/// before it is thrown. Thread: one.
class WatchedDrive {
 public:
  /// `lasers`: the model's, in its order. The devices outlive it; so does `stopped`, which says that a
  /// person wants it to end.
  WatchedDrive(const WatchedDriveSetup& setup, DriveBase& drive, std::span<LaserScanner* const> lasers, Clock& clock,
               const std::function<bool()>& stopped);

  /// Waits for the next tick, takes what came and commands (rad/s). False where the feedback is not what was commanded.
  /// Throws where drives are in trouble, where feedback or scans stop coming, or where it is to end.
  bool tick(double left_radps, double right_radps);
  /// Until wheels and scans have come to rest.
  void rest();
  /// Whether it could stop at this speed before anything that any scanner sees in the way.
  [[nodiscard]] bool has_room(const Twist2& way) const;
  [[noreturn]] void give_up(const std::string& cause, const std::string& remedy);

  [[nodiscard]] Time due() const { return due_; }
  [[nodiscard]] const WheelState& wheels() const { return wheels_; }
  /// Measured delay from a command to its feedback, s; 0: not known yet.
  [[nodiscard]] double response_s() const { return response_.seconds(); }
  /// Of each scanner, blanked; the last that came.
  [[nodiscard]] const std::vector<LaserScan>& scans() const { return scans_; }

 private:
  void command(double left_radps, double right_radps);
  void take_scans();
  void require_well(Time now);

  WatchedDriveSetup setup_;
  DriveBase& drive_;
  std::vector<LaserScanner*> lasers_;
  Clock& clock_;
  const std::function<bool()>& stopped_;
  std::vector<StopZone> zones_;  ///< one a scanner
  FeltMotion felt_;
  DriveResponse response_;
  Time began_, due_;
  WheelState wheels_;
  std::vector<LaserScan> scans_;
  WheelCommand sent_;
};

// The motions of a commissioning run: each wheel a little forward and back, the other one at rest.

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

/// Judges each drive by its feedback, then what each scanner's scans show of each nudge against it; of several each
/// part begins with the scanner's name. Wirings that look alike are named together.
[[nodiscard]] std::vector<CheckedPart> judge_nudges(const std::vector<Nudge>& nudges, const RobotModel& model);

}  // namespace jaywalk
