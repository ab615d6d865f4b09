#include "apps/formats/bag_file.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <yaml-cpp/yaml.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

bool unpack_lz4(std::string_view packed, std::string& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0U) return false;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owned(context,
                                                                                   &LZ4F_freeDecompressionContext);
  std::size_t taken = 0, given = 0, left = 1;  // left: 0 when the frame is whole
  while (taken < packed.size() && left != 0) {
    std::size_t from = packed.size() - taken, to = out.size() - given;
    left = LZ4F_decompress(context, out.data() + given, &to, packed.data() + taken, &from, nullptr);
    if (LZ4F_isError(left) != 0U || (from == 0 && to == 0)) return false;
    taken += from, given += to;
  }
  return left == 0 && given == out.size();
}

bool unpack_bz2(std::string_view packed, std::string& out) {
  auto bytes = static_cast<unsigned>(out.size());
  std::string source(packed);  // its interface wants what it could write to
  const int code =
      BZ2_bzBuffToBuffDecompress(out.data(), &bytes, source.data(), static_cast<unsigned>(source.size()), 0, 0);
  return code == BZ_OK && bytes == out.size();
}

/// Unpacks zstd's frames that do not say how much comes out, at most `most` bytes.
std::optional<std::string> unpack_frames(std::string_view packed, std::size_t most) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  std::string out;
  std::string block(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t left = 1;  // 0 when a frame is whole
  while (in.pos < in.size || left != 0) {
    ZSTD_outBuffer to{block.data(), block.size(), 0};
    const std::size_t before = in.pos;
    left = ZSTD_decompressStream(stream.get(), &to, &in);
    if (ZSTD_isError(left) != 0U || (to.pos == 0 && in.pos == before)) return std::nullopt;
    if (out.size() + to.pos > most) return std::nullopt;
    out.append(block.data(), to.pos);
  }
  return out;
}

constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";

enum class Format { kNone, kMcap, kRos1, kSqlite, kZstd };

Format format_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(16, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto begins = [&](std::string_view magic) { return head.rfind(magic, 0) == 0; };
  if (begins("\x89MCAP")) return Format::kMcap;
  if (begins("#ROS")) return Format::kRos1;
  if (begins("SQLite format 3")) return Format::kSqlite;
  return begins(kZstdMagic) ? Format::kZstd : Format::kNone;
}

/// Files of the folder itself: names in metadata.yaml lead nowhere else. One that was packed or unpacked by hand since
/// is meant by its other name.
std::filesystem::path inside(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = folder / std::filesystem::path(name).filename();
  std::filesystem::path other = file;
  if (file.extension() == ".zstd")
    other.replace_extension();
  else
    other += ".zstd";
  return !std::filesystem::exists(file) && std::filesystem::exists(other) ? other : file;
}

/// The files that a rosbag2 folder's list names; none where it is empty, as loss of power leaves it.
std::vector<std::filesystem::path> listed_files(const std::filesystem::path& metadata) {
  std::vector<std::filesystem::path> files;
  try {
    const YAML::Node all = YAML::LoadFile(metadata.string());
    if (!all.IsMap()) return files;
    for (const YAML::Node& file : all["rosbag2_bagfile_information"]["relative_file_paths"])
      files.push_back(inside(metadata.parent_path(), file.as<std::string>()));
  } catch (const YAML::Exception& error) {
    throw StartupError(metadata.string() + ":" + std::to_string(std::max(error.mark.line, 0) + 1) + ": " + error.msg,
                       "give what 'ros2 bag reindex' makes of the folder");
  }
  return files;
}

/// The recordings that lie in it, by their names: b_2 before b_10.
std::vector<std::filesystem::path> found_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && format_of(entry.path()) != Format::kNone) files.push_back(entry.path());
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return ::strverscmp(a.c_str(), b.c_str()) < 0; });
  return files;
}

/// What a packed file unpacks to, for as long as it is read.
class UnpackedFile {
 public:
  explicit UnpackedFile(const std::filesystem::path& packed)
      : path_(std::filesystem::temp_directory_path() / ("jaywalk_bag_" + std::to_string(getpid()))) {
    ByteFile file(packed, "take an undamaged copy of it");
    const auto bytes = unpack_frames(file.read(0, file.size()), 4 * kMostRecordBytes);
    if (!bytes) file.refuse(0, "it does not unpack");
    write_text(path_, *bytes, "free some space, or set TMPDIR");
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

struct Closes {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// rosbag2's first storage: the tables topics and messages of an SQLite 3 file.
class Database {
 public:
  explicit Database(const std::filesystem::path& file) : file_(file) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) refuse("no SQLite file that can be read");
    sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);  // its tables are a stranger's
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  }
  void ask(const char* query) {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query, -1, &made, nullptr) != SQLITE_OK) refuse_as_sqlite();
    answer_.reset(made);
  }
  /// Moves on to the next row of the answer; false at its end.
  bool next() {
    const int code = sqlite3_step(answer_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) refuse_as_sqlite();
    return code == SQLITE_ROW;
  }
  [[nodiscard]] std::int64_t number(int column) const { return sqlite3_column_int64(answer_.get(), column); }
  [[nodiscard]] std::string_view bytes(int column) const {
    const void* at = sqlite3_column_blob(answer_.get(), column);
    const int size = sqlite3_column_bytes(answer_.get(), column);
    return at == nullptr ? "" : std::string_view(static_cast<const char*>(at), static_cast<std::size_t>(size));
  }
  [[noreturn]] void refuse(const std::string& cause) const {
    throw StartupError(file_.string() + ": " + cause,
                       "take an undamaged copy of it, or what 'sqlite3 FILE .recover' makes of this one");
  }

 private:
  [[noreturn]] void refuse_as_sqlite() const { refuse(std::string("SQLite says: ") + sqlite3_errmsg(database_.get())); }

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Closes> database_;
  std::unique_ptr<sqlite3_stmt, Closes> answer_;  ///< to the last question
};

void read_sqlite_bag(const std::filesystem::path& file, const BagSink& sink) {
  Database database(file);
  database.ask("PRAGMA quick_check(1)");
  if (!database.next() || database.bytes(0) != "ok")
    database.refuse("damaged or cut: " + std::string(database.bytes(0)));
  database.ask(
      "SELECT m.id, t.id IS NULL, t.name, t.type, t.serialization_format, m.timestamp, m.data "
      "FROM messages m LEFT JOIN topics t ON t.id = m.topic_id ORDER BY m.timestamp, m.id");
  while (database.next()) {
    if (database.number(1) != 0)
      database.refuse("message " + std::to_string(database.number(0)) +
                      " is of a topic that the bag does not describe");
    if (database.bytes(4) != "cdr") continue;
    const Time logged{std::chrono::nanoseconds(database.number(5))};
    sink({database.bytes(2), ros1_name(database.bytes(3)), Wire::kCdr, logged, database.bytes(6)});
  }
}

/// Returns what was left out, as read_bag().
std::string read_file(const std::filesystem::path& file, const BagSink& sink) {
  require_readable(file, file.string() + ": ", "give a recording");
  switch (format_of(file)) {
    case Format::kMcap: return read_mcap(file, sink);
    case Format::kRos1: read_ros1_bag(file, sink); return "";
    case Format::kSqlite: read_sqlite_bag(file, sink); return "";
    case Format::kZstd: {
      const UnpackedFile unpacked(file);
      if (format_of(unpacked.path()) == Format::kZstd) break;
      return read_file(unpacked.path(), sink);
    }
    case Format::kNone: break;
  }
  throw StartupError(file.string() + ": no recording that is known here",
                     "give an MCAP file, a ROS 2 bag or a ROS 1 bag");
}

/// Passes messages on that rosbag2 packed one by one (compression_mode "message"): no message in CDR begins so. What
/// does not unpack is an empty one.
BagSink unpacking(const BagSink& sink) {
  return [&sink](const BagMessage& message) {
    if (message.wire != Wire::kCdr || message.bytes.rfind(kZstdMagic, 0) != 0) return sink(message);
    const auto unpacked = unpack_frames(message.bytes, kMostRecordBytes);
    BagMessage whole = message;
    whole.bytes = unpacked ? std::string_view(*unpacked) : std::string_view();
    sink(whole);
  };
}

/// The parts of a recording in the order of their times; a damaged one is left out, and told.
std::vector<std::filesystem::path> in_order(const std::vector<std::filesystem::path>& parts, std::string& left_out) {
  std::vector<std::pair<Time, std::filesystem::path>> timed;
  for (const std::filesystem::path& part : parts) {
    std::vector<Time> logged;
    try {
      (void)read_file(part, [&](const BagMessage& message) { logged.push_back(message.logged); });
    } catch (const StartupError& error) {
      left_out += "left out: " + std::string(error.what()) + "\n";
      continue;
    }
    if (logged.empty()) continue;
    const auto middle = logged.begin() + static_cast<std::ptrdiff_t>(logged.size() / 2);
    std::nth_element(logged.begin(), middle, logged.end());
    timed.emplace_back(*middle, part);
  }
  if (timed.empty()) return parts;
  std::stable_sort(timed.begin(), timed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::filesystem::path> ordered;
  for (const auto& part : timed) ordered.push_back(part.second);
  return ordered;
}

}  // namespace

ByteFile::ByteFile(const std::filesystem::path& file, std::string remedy)
    : file_(file), remedy_(std::move(remedy)), in_(file, std::ios::binary) {
  require_readable(file, name() + ": ", "give a recording");
  size_ = std::filesystem::file_size(file);
}

std::string ByteFile::read(std::uint64_t at, std::uint64_t bytes) {
  if (bytes > kMostRecordBytes) refuse(at, "a record of " + std::to_string(bytes) + " bytes");
  if (at > size_ || bytes > size_ - at) refuse(at, "the file ends before what begins here");
  std::string out(bytes, '\0');
  in_.seekg(static_cast<std::streamoff>(at));
  in_.read(out.data(), static_cast<std::streamsize>(bytes));
  if (!in_) refuse(at, "cannot be read");
  return out;
}

void ByteFile::refuse(std::uint64_t at, const std::string& cause) const {
  throw StartupError(name() + ": byte " + std::to_string(at) + ": " + cause, remedy_);
}

std::string ByteFile::unpacked(std::uint64_t at, std::string_view method, std::string_view packed,
                               std::uint64_t bytes) const {
  if (bytes > kMostRecordBytes) refuse(at, "a chunk of " + std::to_string(bytes) + " bytes");
  if (method.empty() || method == "none") {
    if (packed.size() != bytes) refuse(at, "a chunk that does not unpack");
    return std::string(packed);
  }
  std::string out(bytes, '\0');
  bool whole = false;
  if (method == "zstd")
    whole = ZSTD_decompress(out.data(), bytes, packed.data(), packed.size()) == bytes;
  else if (method == "lz4")
    whole = unpack_lz4(packed, out);
  else if (method == "bz2")
    whole = unpack_bz2(packed, out);
  else
    refuse(at, "a chunk packed with '" + shown(method) + "', which is not known here");
  if (!whole) refuse(at, "a chunk that does not unpack");
  return out;
}

bool is_bag(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) || format_of(path) != Format::kNone;
}

std::string read_bag(const std::filesystem::path& path, const BagSink& sink) {
  const BagSink whole = unpacking(sink);
  std::string left_out;
  std::vector<std::filesystem::path> files{path};
  if (std::filesystem::is_directory(path)) {
    const std::filesystem::path metadata = path / "metadata.yaml";
    files = std::filesystem::exists(metadata) ? listed_files(metadata) : decltype(files){};
    if (files.empty()) {
      files = found_files(path);
      if (files.size() > 1) files = in_order(files, left_out);
    }
    if (files.empty()) throw StartupError(path.string() + ": no recording in this folder", "give a ROS 2 bag's folder");
  }
  for (const std::filesystem::path& file : files) left_out += read_file(file, whole);
  return left_out;
}

}  // namespace jaywalk::exchange
