#pragma once
// Recordings of ROS's tools, a message at a time: MCAP files, ROS 2 bags (folders, sqlite3), ROS 1 bags.
// A file of bytes, read where a format says that something stands.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "apps/formats/wire_reader.h"
#include "hal/types/time.h"

namespace jaywalk::exchange {

/// Most bytes of one record, packed or not: a file that asks for more is damaged.
inline constexpr std::uint64_t kMostRecordBytes = 1U << 30U;

class ByteFile {
 public:
  /// `remedy`: what a person is told to do where it is damaged. Throws StartupError where it cannot be read.
  ByteFile(const std::filesystem::path& file, std::string remedy);

  /// Throws StartupError where the file ends before, or more than kMostRecordBytes are asked for.
  [[nodiscard]] std::string read(std::uint64_t at, std::uint64_t bytes);
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

// Compression formats of recordings.

/// `packed` in zstd's frames, lz4's frames or bzip2's, by the names that the formats give them: "zstd", "lz4", "bz2";
/// "" and "none" are not packed. `bytes`: how many come out, exactly. Nothing where they do not.
[[nodiscard]] std::optional<std::string> unpack(std::string_view method, std::string_view packed, std::size_t bytes);
/// Whether unpack() knows the method.
[[nodiscard]] bool can_unpack(std::string_view method);

/// zstd's frames that do not say how much comes out, at most `most` bytes.
[[nodiscard]] std::optional<std::string> unpack_zstd(std::string_view packed, std::size_t most);

/// One of zstd's frames, at its fastest usual level.
[[nodiscard]] std::string packed_zstd(std::string_view bytes);

/// One message; what it refers to outlives the call only.
struct BagMessage {
  std::string_view topic;
  std::string_view type;  ///< "sensor_msgs/LaserScan": in the form of ROS 1, also from files of ROS 2
  Wire wire = Wire::kCdr;
  Time logged = kNever;  ///< when it was recorded
  std::string_view bytes;
};
using BagSink = std::function<void(const BagMessage&)>;

/// Whether `path` is a folder, or a file that begins as one of the formats does.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// Every message of a ROS type in the file or folder, in its order; messages that rosbag2 packed one by one come
/// unpacked. The parts of a folder without a list of them (metadata.yaml is written last) come by the middle one of
/// their messages' times, equal ones by their names in natural order. A damaged part of several is left out there, and
/// so is what a cut MCAP file lacks; returns what was left out, a line each. Throws StartupError with place, cause and
/// remedy for what cannot be read or is damaged: all check sums that a format has are checked.
[[nodiscard]] std::string read_bag(const std::filesystem::path& path, const BagSink& sink);

/// The single formats; read_bag() tells them apart.
[[nodiscard]] std::string read_mcap(const std::filesystem::path& file, const BagSink& sink);
void read_ros1_bag(const std::filesystem::path& file, const BagSink& sink);
void read_sqlite_bag(const std::filesystem::path& file, const BagSink& sink);

/// An attachment of an MCAP file: where its bytes are.
struct Attachment {
  std::uint64_t at = 0, bytes = 0;
};
/// The first attachment of that name; 0 bytes where there is none. Throws StartupError as read_mcap().
[[nodiscard]] Attachment find_attachment(const std::filesystem::path& file, std::string_view name);
[[nodiscard]] bool is_mcap(const std::filesystem::path& file);

}  // namespace jaywalk::exchange
