#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "firmware/control_loop.h"
#include "firmware/exchange/mcap_writer.h"
#include "firmware/recording/tick_record.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// A run as an MCAP file, tick by tick, and a metadata.yaml beside it. Thread: one, between ticks.
class RunExporter {
 public:
  /// Throws StartupError when the file cannot be made.
  RunExporter(const std::filesystem::path& file, const RobotModel& model);

  /// What the tick and its loop tell.
  void add(const TickRecord& t, const ControlLoop& loop);
  /// Attaches the recording, where there is one, so that `jaywalk replay` comes to the same commands, and ends the
  /// files. Throws StartupError where the disk did not take all.
  void finish(const std::optional<std::filesystem::path>& recording);
  [[nodiscard]] const exchange::McapWriter& file() const { return file_; }

 private:
  void add_scan(const TickRecord& t, const ControlLoop& loop);
  [[nodiscard]] bool same_goal(const OperatorInput& input) const;
  std::uint16_t channel(const char* topic, const char* type);

  std::filesystem::path path_;
  exchange::McapWriter file_;
  RobotModel model_;
  std::uint16_t scan_ = channel("/scan", "sensor_msgs/msg/LaserScan"),
                points_ = channel("/points", "sensor_msgs/msg/PointCloud2"),
                odom_ = channel("/odom", "nav_msgs/msg/Odometry"), tf_ = channel("/tf", "tf2_msgs/msg/TFMessage"),
                map_ = channel("/map", "nav_msgs/msg/OccupancyGrid"), plan_ = channel("/plan", "nav_msgs/msg/Path"),
                goal_ = channel("/goal_pose", "geometry_msgs/msg/PoseStamped"),
                tracks_ = channel("/tracks", "visualization_msgs/msg/MarkerArray"),
                diagnostics_ = channel("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray"),
                cmd_vel_ = channel("/cmd_vel", "geometry_msgs/msg/Twist");
  std::uint32_t scan_seen_ = 0, plan_seen_ = 0;
  Time mapped_ = kNever, told_ = kNever;
  OperatorInput goal_seen_;
  bool has_goal_ = false;
  Reason reasons_ = Reason::kNone;
};

}  // namespace jaywalk
