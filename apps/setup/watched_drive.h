#pragma once
// Wheels turned by a program that watches them: for commissioning and calibration.
#include <functional>
#include <string>

#include "firmware/safety/felt_motion.h"
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
  /// The devices outlive it; so does `stopped`, which says that a person wants it to end.
  WatchedDrive(const WatchedDriveSetup& setup, DriveBase& drive, LaserScanner& laser, Clock& clock,
               const std::function<bool()>& stopped);

  /// Waits for the next tick, takes what came and commands (rad/s). False where the feedback is not what was commanded.
  /// Throws where drives are in trouble, where feedback or scans stop coming, or where it is to end.
  bool tick(double left_radps, double right_radps);
  /// Until wheels and scans have come to rest.
  void rest();
  /// Whether it could stop at this speed before anything that stands in the way.
  [[nodiscard]] bool has_room(const Twist2& way) const;
  [[noreturn]] void give_up(const std::string& cause, const std::string& remedy);

  [[nodiscard]] Time due() const { return due_; }
  [[nodiscard]] const WheelState& wheels() const { return wheels_; }
  /// Blanked; the last that came.
  [[nodiscard]] const LaserScan& scan() const { return scan_; }

 private:
  void command(double left_radps, double right_radps);
  void require_well(Time now);

  WatchedDriveSetup setup_;
  DriveBase& drive_;
  LaserScanner& laser_;
  Clock& clock_;
  const std::function<bool()>& stopped_;
  StopZone zone_;
  FeltMotion felt_;
  Time began_, due_;
  WheelState wheels_;
  LaserScan scan_;
  WheelCommand sent_;
};

}  // namespace jaywalk
