#pragma once
// Wheel radii, track width and the laser's mount from what wheels and scans say of the same motions, by least squares
// (Censi, Franchi, Marchionni and Oriolo, "Simultaneous calibration of odometry and sensor parameters for mobile
// robots", IEEE Transactions on Robotics 29(2), 2013: the same unknowns and residuals; solved here by Gauss and Newton
// from what is believed, with each match's own information, instead of in closed form).
#include <cstdint>
#include <string>
#include <vector>

#include "apps/setup/watched_drive.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// What both wheels had turned by then (rad).
struct WheelTurns {
  Time stamp = kNever;
  double left_rad = 0.0, right_rad = 0.0;
};

/// Data that a calibration takes from a drive: wheel angles throughout, and scans at a fixed spacing of way, 2000 at
/// most.
class CalibrationLog {
 public:
  /// `drive`: what is believed; it decides when a scan is far enough from the one before.
  explicit CalibrationLog(const DriveModel& drive) : drive_(drive) {}

  /// A tick's newest reading and scan; the same ones again are passed over.
  void take(const WheelState& wheels, const LaserScan& scan);

  [[nodiscard]] const std::vector<LaserScan>& scans() const { return scans_; }
  /// Between two readings, and straight on before the first and after the last.
  [[nodiscard]] WheelTurns at(Time stamp) const;
  /// The readings from one time to another, with the turns at both ends; readings that jump or are late leave it empty.
  [[nodiscard]] std::vector<WheelTurns> between(Time from, Time to) const;

 private:
  [[nodiscard]] bool is_far_from_last() const;

  DriveModel drive_;
  std::uint32_t wheel_sequence_ = 0, scan_sequence_ = 0;
  WheelTurns at_last_scan_;
  std::vector<WheelTurns> wheels_;
  std::vector<LaserScan> scans_;
};

/// Drives armed wheels: 1.5 m forward (half of it at least, where something stands in the way), half a turn left, back,
/// half a turn right, a circle to the left and one to the right; about 50 s. It needs 1.5 m and the body's length
/// ahead, and a metre to each side. The stop zone is in force all the way; where a turn or a circle has no room, or a
/// wheel does not obey, it ends at rest with a StartupError, as it does where `stopped` says so. Returns a log of each
/// scanner.
[[nodiscard]] std::vector<CalibrationLog> drive_guided(const ArmedRobot& robot);

struct RobotGeometry {
  double left_radius_m = 0.0, right_radius_m = 0.0, track_width_m = 0.0;
  Pose2 robot_from_laser;
};

/// What the model says of the wheels and of one scanner's mount.
[[nodiscard]] RobotGeometry believed_of(const RobotModel& model, std::size_t scanner = 0);

struct Calibration {
  RobotGeometry found;
  /// Half of each 95 % confidence interval: radii, track, mount's x, y (m), yaw (rad, in found's places). They hold
  /// what the residuals scatter, not what all of them have in common.
  RobotGeometry within;
  /// Motions of the laser by wheels and mount, less those by the scans: as believed, and as found; of those in use.
  std::vector<Pose2> before, after;
  std::size_t left_out = 0;  ///< motions that fit nothing: slip, wrong matches
};

/// From a drive that turned and went straight. `believed` is where the search begins: good to a tenth, 10 cm and 10
/// degrees. Throws StartupError where fewer than ten motions can be matched; `scans` names the scans in its message.
/// Start-up only: takes seconds and allocates.
[[nodiscard]] Calibration calibrate(const CalibrationLog& log, const RobotGeometry& believed,
                                    const std::string& scans = "scans");

}  // namespace jaywalk
