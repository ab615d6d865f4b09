#pragma once
// A pose with its covariance, and how poses differ.
#include <Eigen/Core>

#include "hal/types/geometry.h"
#include "planner/localization/coasting.h"

namespace jaywalk {

/// Covariances are of (x, y, heading) in the map: m^2, m rad, rad^2; information is their inverse.
struct PoseBelief {
  Pose2 map_from_robot;
  Eigen::Matrix3d covariance;
};

[[nodiscard]] Eigen::Matrix3d diagonal(double xx, double yy, double hh) noexcept;

/// `by` in the map's directions, and turned.
[[nodiscard]] Pose2 moved(const Pose2& pose, const Eigen::Vector3d& by) noexcept;
/// What to be moved by to get from one to the other; the turn in [-pi, pi).
[[nodiscard]] Eigen::Vector3d offset(const Pose2& from, const Pose2& to) noexcept;

/// Normalised innovation squared: the squared Mahalanobis distance of two poses, chi-squared of three where
/// `covariance` is that of their difference (Bar-Shalom and others 2001, 5.4.2).
[[nodiscard]] double nis(const Pose2& from, const Pose2& to, const Eigen::Matrix3d& covariance) noexcept;

/// Doubt about the pose: after a stall of the program or silent wheels, and after the robot was carried.
///
/// Coasting over a gap is a guess. The scan matcher may choose a wrong wall once the guess may be off by more than its
/// window. Wheel angles that count on from before a gap end that doubt; a fix ends either. A search of the map does
/// not: for a carried robot it found wrong places that fit, 7 and 11 m off. In doubt nothing is matched or mapped.
/// Thread: the loop's.
class PoseDoubt {
 public:
  /// Adds the variance of a guessed step.
  void coasted(const Coasting::Step& step) noexcept;
  /// A scan was found in the map.
  void matched() noexcept {
    if (!is_doubtful()) settle();
  }
  /// Begins the doubt of a robot that was lifted, pushed or turned by hand; its wheels did not turn.
  void carried() noexcept { carried_ = true; }
  /// Ends the doubt of a gap: the wheels counted through it.
  void counted_on() noexcept { position_var_ = heading_var_ = 0.0, doubtful_ = false; }
  /// Ends all doubt: the pose is known.
  void settle() noexcept { *this = {}; }

  [[nodiscard]] bool is_doubtful() const noexcept { return doubtful_ || carried_; }

 private:
  double position_var_ = 0.0, heading_var_ = 0.0;  ///< of what was guessed since the last match, m^2 and rad^2
  bool doubtful_ = false;                          ///< these are too great
  bool carried_ = false;
};

}  // namespace jaywalk
