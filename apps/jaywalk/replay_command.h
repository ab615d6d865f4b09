#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/view_server.h"
#include "hal/types/geometry.h"

namespace jaywalk {

struct ReplayOptions {
  std::vector<std::filesystem::path> logs;
  std::string format;                  ///< scan-odom, carmen, bag or jaywalk; empty: by what the file begins with
  std::string scan_topic, odom_topic;  ///< of a bag; empty: the only one of its type
  std::optional<Vec2> goal;            ///< default: the recording's last pose
  std::optional<Pose2> laser_mount;    ///< robot_from_laser; default: the log's own word, else the robot's origin
  std::string model;  ///< p3dx, wheelchair, or a robot model file; empty: p3dx, its laser at the origin
  std::filesystem::path out = "out/replay";
  bool save_map = false;                  ///< what the robot saw, as map_server files
  bool mcap = false;                      ///< leave run.mcap as well
  bool json = false;                      ///< print the summary, in place of a line
  std::optional<view::ViewAddress> view;  ///< serve the live page here, until an interruption
};

/// Recorded laser and odometry through the whole pipeline except the wheels. For a recording of our own every command
/// is compared, bit for bit. Returns 0, or 1 when such a command differs. Throws StartupError for bad input.
[[nodiscard]] int run_replay(ReplayOptions options);

}  // namespace jaywalk
