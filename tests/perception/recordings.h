#pragma once
// Reading recordings for the tests that measure.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk::recordings {

struct StampedPose {
  double t_s = 0.0;
  Pose2 pose;
};

struct Label {
  double t_s = 0.0;
  Vec2 in_laser;
  bool walks = true;  ///< where the table says so in its last column
};

struct Recording {
  std::vector<LaserScan> scans;
  std::vector<StampedPose> odometry;   ///< empty where the recording has none
  std::vector<StampedPose> reference;  ///< a pose a scan, corrected by others; empty where there is none
};

/// Text files, gzipped or not.
[[nodiscard]] Recording read_scan_odom(const std::filesystem::path& scans,
                                       const std::optional<std::filesystem::path>& odometry);
[[nodiscard]] Recording read_carmen(const std::filesystem::path& file);
[[nodiscard]] std::vector<Label> read_labels(const std::filesystem::path& file);

/// Wheels that would have made a robot drive from pose to pose along arcs.
class WheelsFromPoses {
 public:
  explicit WheelsFromPoses(const DriveModel& drive) : drive_(drive) {}
  [[nodiscard]] WheelState reading(const StampedPose& at);

 private:
  DriveModel drive_;
  StampedPose last_;
  WheelState wheels_;
};

}  // namespace jaywalk::recordings
