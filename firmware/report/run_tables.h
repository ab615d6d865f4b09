#pragma once
#include <filesystem>

#include "firmware/report/csv_file.h"
#include "firmware/report/run_sample.h"

namespace jaywalk {

/// robot.csv, movers.csv and tracks.csv (columns: docs/outputs.md), a tick at a time.
class RunTables {
 public:
  /// Throws StartupError when `folder` cannot be written to.
  explicit RunTables(const std::filesystem::path& folder);
  void add(const RunSample& sample);
  /// Throws StartupError naming a table that the disk did not take whole.
  void close();

 private:
  void add_robot(const RunSample& sample);
  void add_movers(const RunSample& sample);
  void add_tracks(const RunSample& sample);

  CsvFile robot_, movers_, tracks_;
  std::uint32_t scan_sequence_ = 0;
};

}  // namespace jaywalk
