#pragma once
// Where a frame lies in another, in space: a transform as ROS's tf has it.
#include <Eigen/Geometry>

#include "hal/types/trig.h"

namespace jaywalk::exchange {

/// parent_from_child: m, and a unit quaternion.
using SpatialFrame = Eigen::Transform<double, 3, Eigen::Isometry>;

/// Of a translation (m) and a quaternion (x, y, z, w) of any length; one of length 0 turns nothing.
[[nodiscard]] inline SpatialFrame spatial_frame(double x, double y, double z, const Eigen::Vector4d& xyzw) {
  SpatialFrame frame = SpatialFrame::Identity();
  frame.translation() = Eigen::Vector3d(x, y, z);
  if (xyzw.norm() > 1e-6) frame.linear() = Eigen::Quaterniond(Eigen::Vector4d(xyzw.normalized())).toRotationMatrix();
  return frame;
}

/// The heading of the frame's x axis in the parent's plane, rad.
[[nodiscard]] inline double heading_of(const SpatialFrame& frame) {
  return atan2(frame.linear()(1, 0), frame.linear()(0, 0));
}

}  // namespace jaywalk::exchange
