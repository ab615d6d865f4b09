#pragma once
// MCAP files (mcap.dev/spec): records of messages in chunks packed with zstd, each with an index, a summary at the end;
// and a run as one.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "apps/formats/ros_topics.h"
#include "firmware/control_setup.h"
#include "hal/text_file.h"
#include "hal/types/time.h"
#include "planner/tracking/tracker.h"

namespace jaywalk {
namespace exchange {

/// Writes one file. What was written before a crash is read up to the last whole chunk. Thread: any, one at a time.
class McapWriter {
 public:
  /// Throws StartupError when the file cannot be made.
  explicit McapWriter(const std::string& file);

  /// A topic of messages of one type in CDR; `schema`: its definition as ROS 2 writes it; `qos`: rosbag2's
  /// profile of it.
  void add_channel(const std::string& topic, const std::string& type, const std::string& schema,
                   const std::string& qos);
  /// One message, its stamp not before 0. `topic`: by the order in which they were added, from 0.
  void write(std::size_t topic, Time stamp, std::string_view message);
  /// A whole file beside the messages, under its own name. Throws StartupError where it cannot be read.
  void attach(const std::filesystem::path& file);
  /// Writes the summary. Throws StartupError when the disk did not take all of the file.
  void close();

  struct Topic {
    std::string name, type;
    std::uint64_t messages = 0;
  };
  [[nodiscard]] const std::vector<Topic>& topics() const { return topics_; }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  /// Of the first message and the last, ns.
  [[nodiscard]] std::uint64_t first_ns() const { return first_ns_; }
  [[nodiscard]] std::uint64_t last_ns() const { return last_ns_; }

 private:
  void put(std::string_view bytes) {
    out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    offset_ += bytes.size();
  }
  void put_chunk();
  [[nodiscard]] std::string statistics() const;

  std::string file_;
  std::ofstream out_;
  std::uint64_t offset_ = 0;
  std::string definitions_;  ///< records of schemas and channels
  std::vector<Topic> topics_;
  std::string chunk_;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::map<std::size_t, std::string> message_index_;  ///< of the chunk at hand: time and offset of each message
  std::string chunk_indexes_, attachment_indexes_;    ///< records
  std::uint32_t chunks_ = 0, attachments_ = 0;
  std::uint64_t messages_ = 0, first_ns_ = 0, last_ns_ = 0;
};

inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

enum McapOp : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kAttachment = 9,
  kAttachmentIndex = 10,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15
};

/// Of zlib and PNG; `so_far`: of what came before.
[[nodiscard]] inline std::uint32_t crc_of(std::string_view bytes, std::uint32_t so_far = 0) {
  return static_cast<std::uint32_t>(
      crc32(so_far, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace exchange

/// A run as an MCAP file, tick by tick, and a metadata.yaml beside it. Thread: one, between ticks.
class RunExporter {
 public:
  /// Throws StartupError when the file cannot be made.
  RunExporter(const std::filesystem::path& file, const ControlSetup& setup);

  /// Messages of one tick, with the tracker's state after it.
  void add(const TickRecord& t, const Tracker& tracker);
  /// Attaches the recording, where there is one (else empty) in one file, so that `jaywalk replay` comes to the same
  /// commands, and ends the files. Throws StartupError where the disk did not take all.
  void finish(const std::filesystem::path& recording);
  [[nodiscard]] const exchange::McapWriter& file() const { return file_; }

 private:
  std::filesystem::path path_;
  exchange::McapWriter file_;
  RobotModel model_;
  exchange::RosTopics topics_;
};

}  // namespace jaywalk
