#pragma once
// Where a laser sits on a robot, from the frames of its recording.
#include <map>
#include <optional>
#include <string>

#include "apps/formats/ros_input.h"
#include "apps/formats/spatial_frame.h"
#include "hal/types/geometry.h"

namespace jaywalk::exchange {

/// Frames by the frame that each lies in, as tf has them: a forest.
class FrameTree {
 public:
  /// What has a NaN says nothing. Names may begin with a slash. What says something else than before makes its frame
  /// one that moves.
  void add(const TransformMessage& transform);
  [[nodiscard]] bool has(const std::string& frame) const { return parents_.count(bare(frame)) > 0; }
  /// base_from_frame, along the tree; nothing where no way joins them, or one of its frames moves.
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
  std::map<std::string, Edge> parents_;
};

/// A laser in the robot's plane.
struct LaserMount {
  Pose2 robot_from_laser;
  bool upside_down = false;  ///< its angles count clockwise, seen from above
};
/// Nothing where its plane is not level to 10 degrees.
[[nodiscard]] std::optional<LaserMount> level_mount(const SpatialFrame& base_from_laser);

}  // namespace jaywalk::exchange
