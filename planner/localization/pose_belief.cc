#include "planner/localization/pose_belief.h"

#include <Eigen/LU>

namespace jaywalk {

Eigen::Matrix3d diagonal(double xx, double yy, double hh) noexcept { return Eigen::Vector3d(xx, yy, hh).asDiagonal(); }

Pose2 moved(const Pose2& pose, const Eigen::Vector3d& by) noexcept {
  return {pose.x + by.x(), pose.y + by.y(), wrap_angle(pose.heading + by.z())};
}

Eigen::Vector3d offset(const Pose2& from, const Pose2& to) noexcept {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.heading - from.heading)};
}

double nis(const Pose2& from, const Pose2& to, const Eigen::Matrix3d& covariance) noexcept {
  const Eigen::Vector3d innovation = offset(from, to);
  return innovation.dot(covariance.inverse() * innovation);
}

}  // namespace jaywalk
