#include "apps/formats/run_exporter.h"

#include <fstream>
#include <string>

#include "apps/formats/ros_schemas.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

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
    : path_(file),
      file_(file.string()),
      model_(model),
      topics_([this](std::size_t topic, Time stamp, const std::string& message) {
        file_.write(channels_[topic], stamp, message);
      }) {
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const auto& [name, type] = exchange::kRosTopics[k];
    channels_[k] = file_.add_channel(name, type, exchange::ros_schema(type));
  }
}

void RunExporter::add(const TickRecord& t, const Tracker& tracker) {
  topics_.add(t, tracker.tracks(), t.path, model_);
  if (t.scan.beam_count > 0 && topics_.is_map_due(t.now)) topics_.add_map(tracker.still(), t.now);
}

void RunExporter::finish(const std::filesystem::path& recording) {
  if (!recording.empty()) file_.attach(recording);
  file_.close();
  write_metadata(path_, file_);
}

}  // namespace jaywalk
