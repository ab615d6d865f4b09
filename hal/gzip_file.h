#pragma once
#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace jaywalk {

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
