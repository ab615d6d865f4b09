#pragma once
// Wheels turned by a program that watches them: for commissioning and calibration.
#include <functional>
#include <span>
#include <string>
#include <vector>

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

}  // namespace jaywalk
