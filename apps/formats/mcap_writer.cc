#include "apps/formats/mcap_writer.h"

#include <zstd.h>

#include <algorithm>

#include "apps/formats/wire_reader.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace exchange {
namespace {

constexpr std::size_t kChunkBytes = 1U << 20U;

std::string u16(std::size_t v) { return raw(static_cast<std::uint16_t>(v)); }
std::string u32(std::size_t v) { return raw(static_cast<std::uint32_t>(v)); }
std::string u64(std::uint64_t v) { return raw(v); }
/// A text or a table behind the number of its bytes.
std::string sized(std::string_view s) { return u32(s.size()).append(s); }

/// One of zstd's frames, at its fastest usual level.
std::string packed_zstd(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));  // with that much room it cannot fail
  return out;
}

std::string record(McapOp op, std::string_view body) {
  return std::string(1, static_cast<char>(op)).append(u64(body.size())).append(body);
}

}  // namespace

McapWriter::McapWriter(const std::string& file) : file_(file), out_(file, std::ios::binary) {
  if (!out_) throw StartupError(file + ": cannot be written", "choose another --out");
  put(kMcapMagic);
  put(record(kHeader, sized("ros2") + sized("jaywalk")));
}

void McapWriter::add_channel(const std::string& topic, const std::string& type, const std::string& schema,
                             const std::string& qos) {
  topics_.push_back({topic, type});
  const std::string number = u16(topics_.size());
  const std::string records = record(kSchema, number + sized(type) + sized("ros2msg") + sized(schema)) +
                              record(kChannel, number + number + sized(topic) + sized("cdr") +
                                                   sized(sized("offered_qos_profiles") + sized(qos)));
  definitions_ += records;
  chunk_ += records;
}

void McapWriter::write(std::size_t topic, Time stamp, std::string_view message) {
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp.time_since_epoch().count(), 0));
  if (message_index_.empty()) chunk_first_ns_ = chunk_last_ns_ = ns;
  if (messages_ == 0) first_ns_ = last_ns_ = ns;
  chunk_first_ns_ = std::min(chunk_first_ns_, ns), chunk_last_ns_ = std::max(chunk_last_ns_, ns);
  first_ns_ = std::min(first_ns_, ns), last_ns_ = std::max(last_ns_, ns);
  message_index_[topic + 1] += u64(ns) + u64(chunk_.size());
  chunk_ += record(kMessage, u16(topic + 1) + u32(topics_[topic].messages) + u64(ns) + u64(ns) + std::string(message));
  ++topics_[topic].messages, ++messages_;
  if (chunk_.size() >= kChunkBytes) put_chunk();
}

void McapWriter::put_chunk() {
  if (chunk_.empty()) return;
  const std::string packed = packed_zstd(chunk_);
  const std::string chunk = record(kChunk, u64(chunk_first_ns_) + u64(chunk_last_ns_) + u64(chunk_.size()) +
                                               u32(crc_of(chunk_)) + sized("zstd") + u64(packed.size()) + packed);
  const std::uint64_t at = offset_, indexes = at + chunk.size();
  put(chunk);
  std::string index_offsets;
  for (const auto& [channel, entries] : message_index_) {
    index_offsets += u16(channel) + u64(offset_);
    put(record(kMessageIndex, u16(channel) + sized(entries)));
  }
  chunk_indexes_ += record(kChunkIndex, u64(chunk_first_ns_) + u64(chunk_last_ns_) + u64(at) + u64(chunk.size()) +
                                            sized(index_offsets) + u64(offset_ - indexes) + sized("zstd") +
                                            u64(packed.size()) + u64(chunk_.size()));
  ++chunks_;
  chunk_.clear();
  message_index_.clear();
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t k = 0; k < topics_.size(); ++k) counts += u16(k + 1) + u64(topics_[k].messages);
  return record(kStatistics, u64(messages_) + u16(topics_.size()) + u32(topics_.size()) + u32(attachments_) + u32(0) +
                                 u32(chunks_) + u64(first_ns()) + u64(last_ns_) + sized(counts));
}

void McapWriter::attach(const std::filesystem::path& file) {
  put_chunk();
  std::ifstream in(file, std::ios::binary);
  const std::uint64_t bytes = std::filesystem::file_size(file);
  const std::string name = sized(file.filename().string()), type = sized("application/octet-stream");
  const std::string head = u64(0) + u64(0) + name + type + u64(bytes);
  const std::uint64_t at = offset_, length = head.size() + bytes + sizeof(std::uint32_t);
  put(std::string(1, static_cast<char>(kAttachment)) + u64(length) + head);
  std::uint32_t crc = crc_of(head);
  std::string block(kChunkBytes, '\0');
  for (std::uint64_t left = bytes; left > 0;) {
    const auto next = static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
    if (!in.read(block.data(), static_cast<std::streamsize>(next)))
      throw StartupError(file.string() + ": cannot be read", "check its permissions");
    crc = crc_of(std::string_view(block).substr(0, next), crc);
    put(std::string_view(block).substr(0, next));
    left -= next;
  }
  put(u32(crc));
  attachment_indexes_ +=
      record(kAttachmentIndex, u64(at) + u64(9 + length) + u64(0) + u64(0) + u64(bytes) + name + type);
  ++attachments_;
}

void McapWriter::close() {
  put_chunk();
  put(record(kDataEnd, u32(0)));  // no CRC of the whole: each chunk has its own
  const std::uint64_t start = offset_;
  std::string summary = definitions_ + chunk_indexes_ + attachment_indexes_ + statistics();
  const std::uint64_t offsets = start + summary.size();
  const auto group = [&](McapOp op, std::uint64_t before, const std::string& records) {
    if (records.empty()) return;
    summary +=
        record(kSummaryOffset, std::string(1, static_cast<char>(op)) + u64(start + before) + u64(records.size()));
  };
  group(kChunkIndex, definitions_.size(), chunk_indexes_);
  group(kAttachmentIndex, definitions_.size() + chunk_indexes_.size(), attachment_indexes_);
  const std::string footer = std::string(1, static_cast<char>(kFooter)) + u64(20) + u64(start) + u64(offsets);
  put(summary);
  put(footer + u32(crc_of(summary + footer)));
  put(kMcapMagic);
  if (!out_.flush()) throw StartupError(file_ + ": the disk did not take all of it", "free some space and run again");
}

}  // namespace exchange

namespace {

/// rosbag2's QoS profile of a topic: reliable, keep last; none of its times are limited.
std::string qos_of(const std::string& name) {
  const bool latched =
      std::ranges::any_of(exchange::kRosTopics, [&](const auto& topic) { return topic.latched && topic.name == name; });
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
  topics_.add(t, tracker.tracks(), t.path, model_);
  if (t.scan.beam_count > 0 && topics_.is_map_due(t.now)) topics_.add_map(tracker.still(), t.now);
}

void RunExporter::finish(const std::filesystem::path& recording) {
  if (!recording.empty()) file_.attach(recording);
  file_.close();
  write_metadata(path_, file_);
}

}  // namespace jaywalk
