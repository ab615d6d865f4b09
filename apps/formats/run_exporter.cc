#include "apps/formats/run_exporter.h"

#include <algorithm>
#include <string>

#include "apps/formats/ros_topics.h"
#include "hal/text_file.h"

namespace jaywalk {
namespace {

/// rosbag2's QoS profile of a topic: reliable, keep last; none of its times are limited.
std::string qos_of(const std::string& name) {
  const auto* const topic = std::find_if(exchange::kRosTopics.begin(), exchange::kRosTopics.end(),
                                         [&](const exchange::RosTopic& one) { return one.name == name; });
  const bool latched = topic != exchange::kRosTopics.end() && topic->latched;
  const std::string for_ever = "\n    sec: 9223372036\n    nsec: 854775807\n";
  return std::string("- history: 1\n  depth: ") + (latched ? "1" : "10") +
         "\n  reliability: 1\n  durability: " + (latched ? "1" : "2") + "\n  deadline:" + for_ever +
         "  lifespan:" + for_ever + "  liveliness: 1\n  liveliness_lease_duration:" + for_ever +
         "  avoid_ros_namespace_conventions: false";
}

std::string in_quotes(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\n");
  return text;
}

/// metadata.yaml beside the file, as `ros2 bag` reads it (rosbag2's version 5).
void write_metadata(const std::filesystem::path& file, const exchange::McapWriter& mcap) {
  std::string topics;
  for (const auto& topic : mcap.topics()) {
    topics += "    - topic_metadata:\n        name: " + topic.name + "\n        type: " + topic.type +
              "\n        serialization_format: cdr\n        offered_qos_profiles: \"" + in_quotes(qos_of(topic.name)) +
              "\"\n      message_count: " + std::to_string(topic.messages) + "\n";
  }
  const std::string lasted = std::to_string(mcap.last_ns() - mcap.first_ns()), began = std::to_string(mcap.first_ns()),
                    count = std::to_string(mcap.messages()), name = file.filename().string();
  write_text(file.parent_path() / "metadata.yaml",
             "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  duration:\n    nanoseconds: " +
                 lasted + "\n  starting_time:\n    nanoseconds_since_epoch: " + began + "\n  message_count: " + count +
                 "\n  topics_with_message_count:\n" + topics +
                 "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " + name +
                 "\n  files:\n    - path: " + name + "\n      starting_time:\n        nanoseconds_since_epoch: " +
                 began + "\n      duration:\n        nanoseconds: " + lasted + "\n      message_count: " + count + "\n",
             "choose another --out");
}

}  // namespace

RunExporter::RunExporter(const std::filesystem::path& file, const ControlSetup& setup)
    : path_(file),
      file_(file.string()),
      model_(setup.model),
      topics_([this](std::size_t topic, Time stamp, const std::string& message) { file_.write(topic, stamp, message); },
              setup.unix_from_loop) {
  for (const auto& [name, type] : exchange::topics_of(model_))
    file_.add_channel(name, type, exchange::ros_schema(type), qos_of(name));
}

void RunExporter::add(const TickRecord& t, const Tracker& tracker) {
  const std::uint32_t every = (1U << file_.topics().size()) - 1U;
  topics_.add(t, tracker.tracks(), t.path, model_, every);
  if (t.scan.beam_count > 0 && topics_.is_map_due(t.now)) topics_.add_map(tracker.still(), t.now);
}

void RunExporter::finish(const std::filesystem::path& recording) {
  if (!recording.empty()) file_.attach(recording);
  file_.close();
  write_metadata(path_, file_);
}

}  // namespace jaywalk
