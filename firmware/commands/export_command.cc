#include "firmware/commands/export_command.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "firmware/commands/progress.h"
#include "firmware/commands/relived_run.h"
#include "firmware/exchange/mcap_writer.h"
#include "firmware/exchange/ros_messages.h"
#include "firmware/exchange/ros_schemas.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kMapEvery = std::chrono::seconds(2);
constexpr Duration kDiagnosticsEvery = std::chrono::milliseconds(100);

/// The topics, and what of the last tick was written of each.
class Exporter {
 public:
  Exporter(const std::string& file, const RobotModel& model) : file_(file), model_(model) {}

  void add(const TickRecord& t, const ControlLoop& loop) {
    file_.write(tf_, t.now, exchange::transforms(t, model_.laser.robot_from_laser));
    file_.write(odom_, t.now, exchange::odometry(t, model_.drive));
    file_.write(cmd_vel_, t.now, exchange::command(t));
    if (t.scan.sequence != scan_seen_ && t.scan.beam_count > 0) add_scan(t, loop);
    if (loop.plan().sequence != plan_seen_ && loop.plan().status == PlanStatus::kOk) {
      file_.write(plan_, t.now, exchange::path(loop.plan()));
      plan_seen_ = loop.plan().sequence;
    }
    if (t.input.has_goal && (!has_goal_ || !same_goal(t.input))) {
      file_.write(goal_, t.now, exchange::goal_pose(t));
      goal_seen_ = t.input;
    }
    has_goal_ = t.input.has_goal;
    if (reasons_ != t.verdict.reasons || age(told_, t.now) >= kDiagnosticsEvery) {
      file_.write(diagnostics_, t.now, exchange::diagnostics(t));
      reasons_ = t.verdict.reasons;
      told_ = t.now;
    }
  }
  exchange::McapWriter& file() { return file_; }

 private:
  void add_scan(const TickRecord& t, const ControlLoop& loop) {
    scan_seen_ = t.scan.sequence;
    file_.write(scan_, t.now, exchange::laser_scan(t.scan));
    file_.write(points_, t.now, exchange::points(t.scan));
    file_.write(tracks_, t.now, exchange::tracks(loop.tracker().tracks(), t.now));
    if (mapped_ != kNever && age(mapped_, t.now) < kMapEvery) return;
    file_.write(map_, t.now, exchange::occupancy(loop.tracker().still(), t.now));
    mapped_ = t.now;
  }
  [[nodiscard]] bool same_goal(const OperatorInput& input) const {
    const bool same_heading = input.wants_heading() == goal_seen_.wants_heading() &&
                              (!input.wants_heading() || input.goal_heading_rad == goal_seen_.goal_heading_rad);
    return input.goal_in_map == goal_seen_.goal_in_map && same_heading;
  }
  std::uint16_t channel(const char* topic, const char* type) {
    return file_.add_channel(topic, type, exchange::ros_schema(type));
  }

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

/// What `ros2 bag` wants beside the file (rosbag2's version 5 of it).
void write_metadata(const std::filesystem::path& file, const exchange::McapWriter& mcap) {
  std::string topics;
  for (const auto& topic : mcap.topics()) {
    topics += "    - topic_metadata:\n        name: " + topic.name + "\n        type: " + topic.type +
              "\n        serialization_format: cdr\n        offered_qos_profiles: \"\"\n      message_count: " +
              std::to_string(topic.messages) + "\n";
  }
  const std::string lasted = std::to_string(mcap.last_ns() - mcap.first_ns()), began = std::to_string(mcap.first_ns()),
                    count = std::to_string(mcap.messages()), name = file.filename().string();
  std::ofstream out(file.parent_path() / "metadata.yaml");
  out << "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  duration:\n    nanoseconds: "
      << lasted << "\n  starting_time:\n    nanoseconds_since_epoch: " << began << "\n  message_count: " << count
      << "\n  topics_with_message_count:\n"
      << topics << "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " << name
      << "\n  files:\n    - path: " << name << "\n      starting_time:\n        nanoseconds_since_epoch: " << began
      << "\n      duration:\n        nanoseconds: " << lasted << "\n      message_count: " << count << "\n";
  if (!out.flush())
    throw StartupError((file.parent_path() / "metadata.yaml").string() + ": cannot be written", "choose another --out");
}

}  // namespace

int run_export(const ExportOptions& options) {
  RelivedRun run(options.run);
  const std::filesystem::path out = options.out.empty() ? run.file().parent_path() / "run.mcap" : options.out;
  std::error_code missing;
  if (std::filesystem::equivalent(run.file(), out, missing))
    throw StartupError(run.file().string() + ": would be overwritten", "choose another --out");
  Exporter exporter(out.string(), run.setup().model);
  Progress progress;
  while (run.step()) {
    exporter.add(run.last(), run.loop());
    if (progress.is_due()) progress.show(run.share_read(), std::to_string(exporter.file().messages()) + " messages");
  }
  progress.make_way();
  std::fputs(run.remarks().c_str(), stderr);
  exporter.file().attach(run.file());  // so that `jaywalk replay` comes to the same commands
  exporter.file().close();
  write_metadata(out, exporter.file());
  std::printf("%s: %llu messages on %zu topics over %.1f s\n", out.c_str(),
              static_cast<unsigned long long>(exporter.file().messages()), exporter.file().topics().size(),
              static_cast<double>(exporter.file().last_ns() - exporter.file().first_ns()) * 1e-9);
  return 0;
}

}  // namespace jaywalk
