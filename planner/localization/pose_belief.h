#pragma once
// A pose with its covariance, and how poses differ.
#include <Eigen/Core>

#include "hal/types/geometry.h"

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

}  // namespace jaywalk
