#pragma once
// Tables of a run on its disk, and the room that is held there for its summary.
#include <filesystem>
#include <string>
#include <vector>

#include "apps/report/csv_file.h"
#include "firmware/run_sample.h"

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

/// robot.csv, movers.csv and tracks.csv (columns: docs/reference/outputs.md), a tick at a time; on the disk within
/// kLongestWait of the ticks' time. A table that the disk does not take ends with its last whole row; the others go on.
class RunTables {
 public:
  static constexpr Duration kLongestWait = std::chrono::milliseconds(500);

  /// Throws StartupError when `folder` cannot be written to.
  explicit RunTables(const std::filesystem::path& folder);
  void add(const RunSample& sample);
  void close();
  /// Goes on after `before`, which has the tracks of the last scan.
  void follow(const RunTables& before) noexcept { scan_count_ = before.scan_count_; }
  /// Of all three, with what is not on the disk yet.
  [[nodiscard]] std::uintmax_t bytes() const noexcept { return robot_.bytes() + movers_.bytes() + tracks_.bytes(); }
  [[nodiscard]] bool is_losing() const noexcept;
  /// AppendFile's, of each table that the disk did not take whole.
  [[nodiscard]] std::vector<std::string> complaints() const;

 private:
  void add_robot(const RunSample& sample);
  void add_movers(const RunSample& sample);
  void add_tracks(const RunSample& sample);

  CsvFile robot_, movers_, tracks_;
  Time written_at_ = kNever;
  std::uint32_t scan_count_ = 0;
};

}  // namespace jaywalk
