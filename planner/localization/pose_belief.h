#pragma once
// Poses with their covariance, doubt about them, and fixes from outside.
#include <Eigen/Core>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/outside_fix.h"
#include "planner/localization/odometry.h"

namespace jaywalk {
/// Covariances are of (x, y, heading) in the map: m^2, m rad, rad^2; information is their inverse.
struct PoseBelief {
  Pose2 map_from_robot;
  Eigen::Matrix3d covariance;
};

[[nodiscard]] inline Eigen::Matrix3d diagonal(double xx, double yy, double hh) noexcept {
  return Eigen::Vector3d(xx, yy, hh).asDiagonal();
}

/// `by` in the map's directions, and turned.
[[nodiscard]] inline Pose2 moved(const Pose2& pose, const Eigen::Vector3d& by) noexcept {
  return {pose.x + by.x(), pose.y + by.y(), wrap_angle(pose.heading + by.z())};
}
/// What to be moved by to get from one to the other; the turn in [-pi, pi).
[[nodiscard]] inline Eigen::Vector3d offset(const Pose2& from, const Pose2& to) noexcept {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.heading - from.heading)};
}

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

/// Variances of a pose that is known as exactly as any can be: no map of 10 cm cells places a robot better, and nobody
/// puts it anywhere more exactly.
inline constexpr double kLeastPositionVar = 0.005 * 0.005;  // m2
inline constexpr double kLeastHeadingVar = 0.002 * 0.002;   // rad2

/// Covariance of a fix that is_usable(), in the map.
[[nodiscard]] Eigen::Matrix3d covariance_of(const OutsideFix& fix) noexcept;

/// What is believed after a fix, each part by its variance. The fix's pose is as is_usable() wants it.
[[nodiscard]] PoseBelief blended(const PoseBelief& predicted, const OutsideFix& fix) noexcept;

/// Whether a robot may be there, known so well; false for NaN. Farther than 10,000 km or turned by more than 100 rad is
/// a mistake, and what that would turn the robot by no number can hold.
[[nodiscard]] bool is_usable(const OutsideFix& fix) noexcept;

/// Tells fixes that belong to what is believed from those that do not: one alone is a mistake of the system outside,
/// three that tell the same place, as the robot moved meanwhile, are a mistake of ours.
class FixGate {
 public:
  enum class Verdict : std::uint8_t { kBlend, kPassOver, kTake };
  /// `odom_from_robot`: when the fix was taken. In doubt no fix belongs to what is believed, however near: blended with
  /// a covariance from before the robot was carried, a fix 0.23 rad off left the heading where it was.
  [[nodiscard]] Verdict judge(const PoseBelief& predicted, bool in_doubt, const OutsideFix& fix,
                              const Pose2& odom_from_robot) noexcept;

 private:
  Pose2 map_from_odom_;  ///< as the last that was passed over has it
  int agreeing_ = 0;
};

}  // namespace jaywalk
