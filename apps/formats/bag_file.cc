#include "apps/formats/bag_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <vector>

#include "apps/formats/byte_file.h"
#include "apps/formats/unpacking.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

enum class Format { kNone, kMcap, kRos1, kSqlite, kZstd };

Format format_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(16, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto begins = [&](std::string_view magic) { return head.rfind(magic, 0) == 0; };
  if (begins("\x89MCAP")) return Format::kMcap;
  if (begins("#ROSBAG")) return Format::kRos1;
  if (begins("SQLite format 3")) return Format::kSqlite;
  return begins("\x28\xB5\x2F\xFD") ? Format::kZstd : Format::kNone;
}

/// What metadata.yaml says of a rosbag2 folder.
struct Folder {
  std::vector<std::filesystem::path> files;
  bool packed_messages = false;
};

/// Files of the folder itself: names in metadata.yaml lead nowhere else.
std::filesystem::path inside(const std::filesystem::path& folder, const std::string& name) {
  return folder / std::filesystem::path(name).filename();
}

Folder described(const std::filesystem::path& metadata) {
  Folder folder;
  try {
    const YAML::Node all = YAML::LoadFile(metadata.string())["rosbag2_bagfile_information"];
    for (const YAML::Node& file : all["relative_file_paths"])
      folder.files.push_back(inside(metadata.parent_path(), file.as<std::string>()));
    const YAML::Node mode = all["compression_mode"];
    std::string said = mode ? mode.as<std::string>() : "";
    std::transform(said.begin(), said.end(), said.begin(), [](unsigned char c) { return std::tolower(c); });
    folder.packed_messages = said == "message";
  } catch (const YAML::Exception& error) {
    throw StartupError(metadata.string() + ":" + std::to_string(std::max(error.mark.line, 0) + 1) + ": " + error.msg,
                       "give what 'ros2 bag reindex' makes of the folder");
  }
  return folder;
}

Folder contents(const std::filesystem::path& path) {
  if (std::filesystem::exists(path / "metadata.yaml")) return described(path / "metadata.yaml");
  Folder folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.is_regular_file() && format_of(entry.path()) != Format::kNone) folder.files.push_back(entry.path());
  }
  std::sort(folder.files.begin(), folder.files.end());
  return folder;
}

/// What a packed file unpacks to, for as long as it is read.
class UnpackedFile {
 public:
  explicit UnpackedFile(const std::filesystem::path& packed)
      : path_(std::filesystem::temp_directory_path() / ("jaywalk_bag_" + std::to_string(getpid()))) {
    ByteFile file(packed, "take an undamaged copy of it");
    const auto bytes = unpack_zstd(file.read(0, file.size()), 4 * kMostRecordBytes);
    if (!bytes) file.refuse(0, "it does not unpack");
    std::ofstream out(path_, std::ios::binary);
    out.write(bytes->data(), static_cast<std::streamsize>(bytes->size()));
    if (!out.flush()) throw StartupError(path_.string() + ": cannot be written", "free some space, or set TMPDIR");
  }
  ~UnpackedFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void read_file(const std::filesystem::path& file, bool packed_messages, const BagSink& sink) {
  require_readable(file, file.string() + ": ", "give a recording");
  switch (format_of(file)) {
    case Format::kMcap:
      return read_mcap(file, sink);
    case Format::kRos1:
      return read_ros1_bag(file, sink);
    case Format::kSqlite:
      return read_sqlite_bag(file, packed_messages, sink);
    case Format::kZstd: {
      const UnpackedFile unpacked(file);
      if (format_of(unpacked.path()) == Format::kZstd) break;
      return read_file(unpacked.path(), packed_messages, sink);
    }
    case Format::kNone:
      break;
  }
  throw StartupError(file.string() + ": no recording that is known here",
                     "give an MCAP file, a ROS 2 bag or a ROS 1 bag");
}

}  // namespace

bool is_bag(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) || format_of(path) != Format::kNone;
}

void read_bag(const std::filesystem::path& path, const BagSink& sink) {
  if (!std::filesystem::is_directory(path)) return read_file(path, false, sink);
  const Folder folder = contents(path);
  if (folder.files.empty())
    throw StartupError(path.string() + ": no recording in this folder", "give a ROS 2 bag's folder");
  for (const std::filesystem::path& file : folder.files) read_file(file, folder.packed_messages, sink);
}

}  // namespace jaywalk::exchange
