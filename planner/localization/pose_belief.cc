#include "planner/localization/pose_belief.h"

#include <Eigen/LU>

namespace jaywalk {
namespace {

// What the matcher's window holds (correlative_search.cc: 0.4 m and 0.42 rad to each side), as standard deviations: a
// third of a second.
constexpr double kMostPositionVar = 0.3 * 0.3, kMostHeadingVar = 0.3 * 0.3;

}  // namespace

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

void PoseDoubt::coasted(const Coasting::Step& step) noexcept {
  position_var_ += step.metres_std * step.metres_std;
  heading_var_ += step.radians_std * step.radians_std;
  doubtful_ = doubtful_ || position_var_ > kMostPositionVar || heading_var_ > kMostHeadingVar;
}

}  // namespace jaywalk
