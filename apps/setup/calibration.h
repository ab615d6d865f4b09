#pragma once
// Wheel radii, track width and the laser's mount from what wheels and scans say of the same motions, by least squares
// (Censi, Franchi, Marchionni and Oriolo, "Simultaneous calibration of odometry and sensor parameters for mobile
// robots", IEEE Transactions on Robotics 29(2), 2013: the same unknowns and residuals; solved here by Gauss and Newton
// from what is believed, with each match's own information, instead of in closed form).
#include <string>
#include <vector>

#include "apps/setup/guided_drive.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

struct RobotGeometry {
  double left_radius_m = 0.0, right_radius_m = 0.0, track_width_m = 0.0;
  Pose2 robot_from_laser;
};

/// What the model says of the wheels and of one scanner's mount.
[[nodiscard]] RobotGeometry believed_of(const RobotModel& model, std::size_t scanner = 0);

/// What wheels and mount say of one motion of the laser, less what the scans say.
struct MotionResidual {
  double x_m = 0.0, y_m = 0.0, turn_rad = 0.0;
};

struct Calibration {
  RobotGeometry found;
  /// Half of each 95 % confidence interval: radii, track, mount's x, y (m), yaw (rad, in found's places). They hold
  /// what the residuals scatter, not what all of them have in common.
  RobotGeometry within;
  std::vector<MotionResidual> before, after;  ///< as believed, and as found; of the motions that were used
  std::size_t left_out = 0;                   ///< motions that fit nothing: slip, wrong matches
};

/// From a drive that turned and went straight. `believed` is where the search begins: good to a tenth, 10 cm and 10
/// degrees. Throws StartupError where fewer than ten motions can be matched; `scans` names the scans in its message.
/// Start-up only: takes seconds and allocates.
[[nodiscard]] Calibration calibrate(const CalibrationLog& log, const RobotGeometry& believed,
                                    const std::string& scans = "scans");

}  // namespace jaywalk
