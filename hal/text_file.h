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
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "hal/types/errors.h"

namespace jaywalk {

/// Throws StartupError, `place` before the cause, where `path` is no regular file or may not be read.
inline void require_readable(const std::filesystem::path& path, const std::string& place, const std::string& expected) {
  std::error_code unknown;
  const auto kind = std::filesystem::status(path, unknown).type();
  if (kind == std::filesystem::file_type::not_found) throw StartupError(place + "no such file", expected);
  if (kind == std::filesystem::file_type::directory) throw StartupError(place + "a folder", expected);
  if (kind != std::filesystem::file_type::regular) throw StartupError(place + "no regular file", expected);
  if (!std::ifstream(path)) throw StartupError(place + "cannot be read", "check its permissions");
}

/// All of a file that must be there. Throws StartupError as require_readable() does, and where reading fails or does
/// not end: the kernel has such regular files.
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

/// Reads a text line by line and knows which one it is at; a carriage return before the line's end is dropped.
class LineReader {
 public:
  /// Throws StartupError where it cannot be read. `remedy`: how lines are written.
  LineReader(const std::filesystem::path& file, std::string remedy)
      : file_(file), remedy_(std::move(remedy)), in_(file) {
    if (!in_) refuse("cannot be read");
  }

  [[nodiscard]] bool next(std::string& line) {
    if (!std::getline(in_, line)) return false;
    ++number_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number_ == 1) drop_byte_order_mark(line);
    return true;
  }
  /// Exactly `count` numbers with blanks or `separator` between them; none where the line is anything else.
  [[nodiscard]] static std::vector<double> numbers(std::string line, std::size_t count, char separator = ' ') {
    std::replace(line.begin(), line.end(), separator, ' ');
    std::istringstream words(line);
    std::vector<double> values(count);
    for (double& value : values) words >> value;
    std::string rest;
    return words && !(words >> rest) ? values : std::vector<double>{};
  }
  /// A table below a first line `header`: calls take(numbers of a row, its text) for each that is not empty.
  template <class Take>
  void read_table(const std::string& header, std::size_t count, const Take& take) {
    std::string line;
    if (next(line) && line != header) refuse("does not begin with " + header);
    while (next(line))
      if (!line.empty()) take(numbers(line, count, ','), line);
  }
  /// Throws StartupError about the line that was read last.
  [[noreturn]] void refuse(const std::string& cause) const {
    throw StartupError(file_.string() + (number_ > 0 ? ":" + std::to_string(number_) : "") + ": " + cause, remedy_);
  }

 private:
  std::filesystem::path file_;
  std::string remedy_;
  std::ifstream in_;
  int number_ = 0;
};

/// Bytes of a file that are one by themselves: by default all of it.
struct FilePart {
  std::uint64_t at = 0;
  std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
};

/// A file to read, packed with gzip or not: zlib gives what is not packed as it is.
class GzipFile {
 public:
  explicit GzipFile(const char* path, FilePart part = {}) : file_(opened(path, part), &gzclose), left_(part.bytes) {}

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }
  /// How many bytes, unpacked, it gave: fewer than asked for at the end or where it is broken.
  [[nodiscard]] std::size_t read(void* to, std::size_t bytes) {
    const bool counts = gzdirect(file_.get()) != 0;  // a packed part says itself where it ends
    const std::uint64_t most = counts ? std::min<std::uint64_t>(bytes, left_) : bytes;
    const int got = gzread(file_.get(), to, static_cast<unsigned>(most));
    failed_ = failed_ || got < 0;
    if (got <= 0) return 0;
    if (counts) left_ -= static_cast<std::uint64_t>(got);
    return static_cast<std::size_t>(got);
  }
  /// Whether zlib says so, or the packed file stops half way.
  [[nodiscard]] bool broken() const {
    int error = Z_OK;
    gzerror(file_.get(), &error);
    return failed_ || (error != Z_OK && error != Z_STREAM_END);
  }
  /// Bytes of the file itself that were used so far.
  [[nodiscard]] double bytes_used() const {
    return static_cast<double>(gzdirect(file_.get()) != 0 ? gztell(file_.get()) : gzoffset(file_.get()));
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

  std::unique_ptr<gzFile_s, int (*)(gzFile)> file_;
  std::uint64_t left_;  ///< of the part
  bool failed_ = false;
};

}  // namespace jaywalk
