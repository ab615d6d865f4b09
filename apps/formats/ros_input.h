#pragma once
// The messages of others that a replay needs, in ROS 1's bytes or ROS 2's.
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/formats/wire_reader.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"
#include "hal/types/trig.h"

namespace jaywalk::exchange {

/// Transform parent_from_child as ROS's tf has it; m.
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

struct StampedMessage {
  Time stamp = kNever;     ///< the header's; 0 where the sender set none
  std::size_t number = 0;  ///< of its topic's messages, from 1
  Time logged = kNever;    ///< when it was recorded
};

/// sensor_msgs/LaserScan, in metres, seconds and radians.
struct ScanMessage : StampedMessage {
  std::string frame;
  float first_angle_rad = 0.0F, angle_step_rad = 0.0F;
  float beam_step_s = 0.0F;
  float range_min_m = 0.0F, range_max_m = 0.0F;
  std::vector<float> range_m;
  Pose2 frame_from_scan;  ///< where its origin lies; sensor_msgs has it in the frame's
};

/// nav_msgs/Odometry, its pose and twist in the plane.
struct OdometryMessage : StampedMessage {
  std::string child_frame;
  Pose2 pose;  ///< its heading is NaN where the quaternion is none: 0 0 0 0, or an angle in place of one
  Twist2 twist;
};

/// One of tf2_msgs/TFMessage.
struct TransformMessage {
  std::string parent, child;
  SpatialFrame parent_from_child;
};

/// Nothing where the bytes are no such message.
[[nodiscard]] std::optional<ScanMessage> read_scan(std::string_view bytes, Wire wire);
[[nodiscard]] std::optional<OdometryMessage> read_odometry(std::string_view bytes, Wire wire);
[[nodiscard]] std::optional<std::vector<TransformMessage>> read_transforms(std::string_view bytes, Wire wire);

/// Frames by the frame that each lies in, as tf has them: a forest.
class FrameTree {
 public:
  /// Adds a transform; one with a NaN is ignored. Frame names may begin with a slash. A frame counts as moving as soon
  /// as two of its transforms differ.
  void add(const TransformMessage& transform);
  /// Returns base_from_frame along the tree; nothing where no chain of frames joins the two, or one in it moves.
  [[nodiscard]] std::optional<SpatialFrame> find(const std::string& base, const std::string& frame) const;

  /// The name without a slash before it, as ROS 1 has some.
  [[nodiscard]] static std::string bare(const std::string& frame) {
    return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame;
  }

 private:
  struct Edge {
    std::string parent;
    SpatialFrame parent_from_child;
    bool moves = false;
  };
  /// Frames with their transforms from the first: the frame itself, what it lies in, and on until one moves.
  using Chain = std::vector<std::pair<std::string, SpatialFrame>>;
  [[nodiscard]] Chain above(const std::string& frame) const;

  std::map<std::string, Edge> parents_;
};

/// A laser in the robot's plane.
struct LaserMount {
  Pose2 robot_from_laser;
  bool upside_down = false;  ///< its angles count clockwise, seen from above
};
/// Nothing where its plane is not level to 10 degrees.
[[nodiscard]] std::optional<LaserMount> level_mount(const SpatialFrame& base_from_laser);

// Foxglove's own messages in protobuf (github.com/foxglove/foxglove-sdk, schemas/proto); nothing where they are none.

/// foxglove.LaserScan: it says no range limits (0 to infinity here) and no times of beams, but where its origin lies.
[[nodiscard]] std::optional<ScanMessage> read_foxglove_scan(std::string_view bytes);
/// foxglove.FrameTransform (one), foxglove.FrameTransforms.
[[nodiscard]] std::optional<std::vector<TransformMessage>> read_foxglove_transform(std::string_view bytes);
[[nodiscard]] std::optional<std::vector<TransformMessage>> read_foxglove_transforms(std::string_view bytes);

}  // namespace jaywalk::exchange
