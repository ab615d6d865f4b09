#pragma once
#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "hal/types/errors.h"

namespace jaywalk {

/// Throws StartupError where `path` is no regular file or may not be read, with `place` before the cause: folders and
/// pipes are none.
inline void require_readable(const std::filesystem::path& path, const std::string& place, const std::string& expected) {
  std::error_code unknown;
  const auto kind = std::filesystem::status(path, unknown).type();
  if (kind == std::filesystem::file_type::not_found) throw StartupError(place + "no such file", expected);
  if (kind == std::filesystem::file_type::directory) throw StartupError(place + "a folder", expected);
  if (kind != std::filesystem::file_type::regular) throw StartupError(place + "no regular file", expected);
  if (!std::ifstream(path)) throw StartupError(place + "cannot be read", "check its permissions");
}

/// All of a file that must be there. Throws StartupError as require_readable() does, and where reading fails on the way
/// or the file is longer than any text of ours: the kernel has regular files that cannot be read, and endless ones.
inline std::string whole_text(const std::filesystem::path& path, const std::string& place,
                              const std::string& expected) {
  constexpr std::size_t kBlock = 1U << 16U, kMostBytes = 1U << 26U;
  require_readable(path, place, expected);
  std::ifstream in(path, std::ios::binary);
  std::string text, block(kBlock, '\0');
  do {
    in.read(block.data(), static_cast<std::streamsize>(kBlock));
    text.append(block, 0, static_cast<std::size_t>(in.gcount()));
  } while (in && text.size() <= kMostBytes);
  if (in.bad()) throw StartupError(place + "cannot be read to its end", expected);
  if (text.size() > kMostBytes) throw StartupError(place + "is longer than 64 MiB", expected);
  return text;
}

/// Some editors and spreadsheets begin a text with three bytes that say "UTF-8".
inline void drop_byte_order_mark(std::string& first_line) {
  constexpr const char* kMark = "\xEF\xBB\xBF";
  if (first_line.rfind(kMark, 0) == 0) first_line.erase(0, 3);
}

/// All of it; empty where it cannot be read.
inline std::string text_in(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Throws StartupError where `file` does not take all of it.
inline void write_text(const std::filesystem::path& file, const std::string& text, const std::string& remedy) {
  std::ofstream out(file, std::ios::binary);
  if (!out) throw StartupError(file.string() + ": cannot be written", remedy);
  out << text;
  if (!out.flush()) throw StartupError(file.string() + ": the disk did not take all of it", remedy);
}

/// Throws StartupError about a line, counted from 1, of a table that `rows` tells how to write; 0: about the whole.
[[noreturn]] inline void refuse_line(const std::filesystem::path& file, int line, const std::string& cause,
                                     const std::string& rows) {
  throw StartupError(file.string() + (line > 0 ? ":" + std::to_string(line) : "") + ": " + cause, rows);
}

/// Bytes of a file that are one by themselves: by default all of it.
struct FilePart {
  std::uint64_t at = 0;
  std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
};

/// A file to read, packed with gzip or not: zlib gives what is not packed as it is.
class GzipFile {
 public:
  explicit GzipFile(const char* path, FilePart part = {}) : file_(opened(path, part)), left_(part.bytes) {}
  ~GzipFile() {
    if (file_ != nullptr) gzclose(file_);
  }
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }
  /// How many bytes, unpacked, it gave: fewer than asked for at the end or where it is broken.
  [[nodiscard]] std::size_t read(void* to, std::size_t bytes) {
    const bool counts = gzdirect(file_) != 0;  // a packed part says itself where it ends
    const std::uint64_t most = counts ? std::min<std::uint64_t>(bytes, left_) : bytes;
    const int got = gzread(file_, to, static_cast<unsigned>(most));
    failed_ = failed_ || got < 0;
    if (got <= 0) return 0;
    if (counts) left_ -= static_cast<std::uint64_t>(got);
    return static_cast<std::size_t>(got);
  }
  /// Whether zlib says so, or the packed file stops half way.
  [[nodiscard]] bool broken() const {
    int error = Z_OK;
    gzerror(file_, &error);
    return failed_ || (error != Z_OK && error != Z_STREAM_END);
  }
  /// Bytes of the file itself that were used so far.
  [[nodiscard]] double bytes_used() const {
    return static_cast<double>(gzdirect(file_) != 0 ? gztell(file_) : gzoffset(file_));
  }

 private:
  static gzFile opened(const char* path, const FilePart& part) {
    if (part.at == 0) return gzopen(path, "rb");
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return nullptr;
    const bool there = lseek(descriptor, static_cast<off_t>(part.at), SEEK_SET) >= 0;
    const gzFile file = there ? gzdopen(descriptor, "rb") : nullptr;
    if (file == nullptr) close(descriptor);
    return file;
  }

  gzFile file_;
  std::uint64_t left_;  ///< of the part
  bool failed_ = false;
};

}  // namespace jaywalk
