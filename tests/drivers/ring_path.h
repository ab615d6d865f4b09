#pragma once
#include <unistd.h>

#include <filesystem>
#include <string>

namespace jaywalk::tests {

/// A name for a shared ring of one test; what lies there goes with it.
class RingPath {
 public:
  RingPath()
      : path_(std::filesystem::temp_directory_path() /
              ("jaywalk_ring_" + std::to_string(::getpid()) + "_" + std::to_string(next()++))) {}
  ~RingPath() { std::filesystem::remove(path_); }
  RingPath(const RingPath&) = delete;
  RingPath& operator=(const RingPath&) = delete;
  operator const std::filesystem::path&() const { return path_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  static int& next() {
    static int number = 0;
    return number;
  }
  std::filesystem::path path_;
};

}  // namespace jaywalk::tests
