#pragma once
// The messages of others that a replay needs, in ROS 1's bytes or ROS 2's.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/formats/spatial_frame.h"
#include "apps/formats/wire_reader.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk::exchange {

/// sensor_msgs/LaserScan, in metres, seconds and radians.
struct ScanMessage {
  Time stamp = kNever;  ///< of the header; 0 where nobody set it
  std::string frame;
  float first_angle_rad = 0.0F, angle_step_rad = 0.0F;
  float beam_step_s = 0.0F;
  float range_min_m = 0.0F, range_max_m = 0.0F;
  std::vector<float> range_m;
  Pose2 frame_from_scan;   ///< where its origin lies; sensor_msgs has it in the frame's
  std::size_t number = 0;  ///< of its topic's messages, from 1
  Time logged = kNever;    ///< when it was recorded
};

/// nav_msgs/Odometry, its pose and twist in the plane.
struct OdometryMessage {
  Time stamp = kNever;
  std::string child_frame;
  Pose2 pose;  ///< its heading is NaN where the quaternion is none: 0 0 0 0, or an angle in place of one
  Twist2 twist;
  std::size_t number = 0;  ///< of its topic's messages, from 1
  Time logged = kNever;    ///< when it was recorded
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

}  // namespace jaywalk::exchange
