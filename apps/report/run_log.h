#pragma once
// What robot.csv says of a run, row by row: for reports in words.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {

struct RunRow {
  double t_s = 0.0;
  Pose2 map_from_robot;  ///< as the controller believed
  bool stands = false;   ///< both wheels' commands are zero
  std::vector<std::string> reasons;
};

/// Reads robot.csv (docs/outputs.md) in order. Memory: a row.
class RunLog {
 public:
  /// Throws StartupError where `file` cannot be read or has not the columns.
  explicit RunLog(const std::filesystem::path& file);

  /// False at the end; a last row that was cut short is the end. Throws StartupError for one that is no row.
  [[nodiscard]] bool next(RunRow& row);

 private:
  [[nodiscard]] std::size_t column(const std::vector<std::string>& names, const std::string& name) const;

  std::filesystem::path file_;
  std::ifstream in_;
  std::size_t line_ = 1, columns_ = 0;
  std::size_t t_ = 0, x_ = 0, y_ = 0, heading_ = 0, left_ = 0, right_ = 0, reasons_ = 0;
};

}  // namespace jaywalk
