#include "firmware/commands/run_exporter.h"

#include <fstream>

#include "firmware/exchange/ros_messages.h"
#include "firmware/exchange/ros_schemas.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kMapEvery = std::chrono::seconds(2);
constexpr Duration kDiagnosticsEvery = std::chrono::milliseconds(100);

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

RunExporter::RunExporter(const std::filesystem::path& file, const RobotModel& model)
    : path_(file), file_(file.string()), model_(model) {}

void RunExporter::add(const TickRecord& t, const ControlLoop& loop) {
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

void RunExporter::add_scan(const TickRecord& t, const ControlLoop& loop) {
  scan_seen_ = t.scan.sequence;
  file_.write(scan_, t.now, exchange::laser_scan(t.scan));
  file_.write(points_, t.now, exchange::points(t.scan));
  file_.write(tracks_, t.now, exchange::tracks(loop.tracker().tracks(), t.now));
  if (mapped_ != kNever && age(mapped_, t.now) < kMapEvery) return;
  file_.write(map_, t.now, exchange::occupancy(loop.tracker().still(), t.now));
  mapped_ = t.now;
}

bool RunExporter::same_goal(const OperatorInput& input) const {
  const bool same_heading = input.wants_heading() == goal_seen_.wants_heading() &&
                            (!input.wants_heading() || input.goal_heading_rad == goal_seen_.goal_heading_rad);
  return input.goal_in_map == goal_seen_.goal_in_map && same_heading;
}

std::uint16_t RunExporter::channel(const char* topic, const char* type) {
  return file_.add_channel(topic, type, exchange::ros_schema(type));
}

void RunExporter::finish(const std::optional<std::filesystem::path>& recording) {
  if (recording) file_.attach(*recording);
  file_.close();
  write_metadata(path_, file_);
}

}  // namespace jaywalk
