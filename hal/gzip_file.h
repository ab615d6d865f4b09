#pragma once
#include <zlib.h>

#include <cstddef>

namespace jaywalk {

/// A file to read, packed with gzip or not: zlib gives what is not packed as it is.
class GzipFile {
 public:
  explicit GzipFile(const char* path) : file_(gzopen(path, "rb")) {}
  ~GzipFile() {
    if (file_ != nullptr) gzclose(file_);
  }
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }
  /// How many bytes, unpacked, it gave: fewer than asked for at the end or where it is broken.
  [[nodiscard]] std::size_t read(void* to, std::size_t bytes) {
    const int got = gzread(file_, to, static_cast<unsigned>(bytes));
    failed_ = failed_ || got < 0;
    return got > 0 ? static_cast<std::size_t>(got) : 0;
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
  gzFile file_;
  bool failed_ = false;
};

}  // namespace jaywalk
