#pragma once
// Recordings of ROS's tools, a message at a time and as a log to replay: MCAP files, ROS 2 bags (folders, sqlite3),
// ROS 1 bags.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "apps/formats/logs/recorded_log.h"
#include "apps/formats/wire_reader.h"
#include "hal/text_file.h"
#include "hal/types/time.h"

namespace jaywalk::exchange {

/// Most bytes of one record, packed or not: a file that asks for more is damaged.
inline constexpr std::uint64_t kMostRecordBytes = 1U << 30U;

/// A file of bytes, read where a format says that something stands.
class ByteFile {
 public:
  /// `remedy`: what a person is told to do where it is damaged. Throws StartupError where it cannot be read.
  ByteFile(const std::filesystem::path& file, std::string remedy);

  /// Throws StartupError where the file ends before, or more than kMostRecordBytes are asked for.
  [[nodiscard]] std::string read(std::uint64_t at, std::uint64_t bytes);
  /// Contents of the compressed chunk at file offset `at`, `bytes` long. `method`: "zstd" or "lz4" (frames), "bz2", ""
  /// or "none" (not compressed). Throws StartupError for any other, and where the chunk is damaged.
  [[nodiscard]] std::string unpacked(std::uint64_t at, std::string_view method, std::string_view packed,
                                     std::uint64_t bytes) const;
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Throws StartupError "FILE: byte N: cause; remedy".
  [[noreturn]] void refuse(std::uint64_t at, const std::string& cause) const;
  [[nodiscard]] std::string name() const { return file_.string(); }

 private:
  std::filesystem::path file_;
  std::string remedy_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

/// One message; what it refers to outlives the call only.
struct BagMessage {
  std::string_view topic;
  std::string_view type;  ///< "sensor_msgs/LaserScan": in the form of ROS 1, also from files of ROS 2
  Wire wire = Wire::kCdr;
  Time logged = kNever;  ///< when it was recorded
  std::string_view bytes;
};
using BagSink = std::function<void(const BagMessage&)>;

/// A type's name in the form of ROS 1; "sensor_msgs/msg/LaserScan" is ROS 2's.
[[nodiscard]] inline std::string ros1_name(std::string_view type) {
  std::string name(type);
  if (const std::size_t msg = name.find("/msg/"); msg != std::string::npos) name.erase(msg, 4);
  return name;
}

/// Whether `path` is a folder, or a file that begins as one of the formats does.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// Every message of a ROS type in the file or folder, in its order; messages that rosbag2 packed one by one come
/// unpacked. The parts of a folder without a list of them (metadata.yaml is written last) come by the median of their
/// messages' times, equal ones by their names in natural order; a damaged one of several is left out. Returns what was
/// left out, and what a cut MCAP file lacks, a line each. Throws StartupError with place, cause and remedy for what
/// cannot be read or is damaged: all check sums that a format has are checked.
[[nodiscard]] std::string read_bag(const std::filesystem::path& path, const BagSink& sink);

/// Single formats; read_bag() tells them apart.
[[nodiscard]] std::string read_mcap(const std::filesystem::path& file, const BagSink& sink);
void read_ros1_bag(const std::filesystem::path& file, const BagSink& sink);

/// An MCAP file's first attachment of that name; 0 bytes where there is none, or it is no MCAP file. Throws
/// StartupError as read_mcap().
[[nodiscard]] FilePart find_attachment(const std::filesystem::path& file, std::string_view name);

struct BagOptions {
  std::string scan_topic = {};                 ///< empty: the only one of type LaserScan
  std::string odom_topic = {};                 ///< empty: the only one of type Odometry, where there is one
  std::optional<Pose2> robot_from_laser = {};  ///< in place of what the recording's frames say
  Pose2 otherwise = {};                        ///< where neither says it
};

/// Topics are told by their types; more than one of a type, and none of LaserScan, is an error that lists them. The
/// mount comes from the frames (/tf_static, and what never moves in /tf) between the odometry's child, else base_link
/// or base_footprint, and the scan's. Stamps are the headers', or where those are 0 the times of recording. Scans of
/// more than 2,048 beams are thinned out evenly; sweeps longer than from scan to scan give way to
/// RecordedLog::spinning_sweep. The log's remark says what was chosen. Leaves out and throws as read_bag() and
/// load_scan_odom() do; throws StartupError where the laser is not level, too.
[[nodiscard]] sim::RecordedLog load_bag(const std::filesystem::path& path, const BagOptions& options);

}  // namespace jaywalk::exchange
