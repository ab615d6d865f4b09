#pragma once
#include <filesystem>

namespace jaywalk {

/// 64 KiB that a run holds in its folder until its end, so that a disk that other files have filled meanwhile still
/// takes its summary.
class DiskReserve {
 public:
  /// Throws StartupError where the disk has no room for it. A file system that cannot hold room is passed over.
  explicit DiskReserve(const std::filesystem::path& folder);
  ~DiskReserve() { release(); }
  DiskReserve(const DiskReserve&) = delete;
  DiskReserve& operator=(const DiskReserve&) = delete;

  void release() noexcept;

 private:
  std::filesystem::path file_;
};

}  // namespace jaywalk
