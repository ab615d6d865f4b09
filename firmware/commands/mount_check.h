#pragma once
#include <optional>

#include "hal/types/geometry.h"

namespace jaywalk {

/// Does the laser look where the wheels drive? A differential drive cannot slip sideways for long: when the poses that
/// scans and wheels agree upon keep sliding to one side, the laser is mounted turned and nobody said so.
class MountCheck {
 public:
  /// The estimated pose at each tick, in order.
  void add(const Pose2& map_from_robot);
  /// The yaw (rad) that robot_from_laser lacks, when the robot drove at least 5 m and slid by more than 0.1 rad; its
  /// estimate rests on poses that the wrong mount had a part in, so it is a hint: run again with it.
  [[nodiscard]] std::optional<double> missing_yaw() const;

 private:
  bool begun_ = false;
  Pose2 before_;
  Vec2 driven_in_robot_;  ///< sum of the steps, each in the robot's frame of its time (m)
};

}  // namespace jaywalk
