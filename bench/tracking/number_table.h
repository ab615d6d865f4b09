#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace jaywalk::bench {

/// A comma-separated table of numbers, plain or .gz, with names of columns in the first line. Cells that are no numbers
/// (empty ones, words) are NaN.
class NumberTable {
 public:
  /// Throws StartupError "FILE:LINE: cause; remedy" for what cannot be read, has no first line, or has a row too short.
  explicit NumberTable(const std::filesystem::path& file);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] bool has(const std::string& column) const { return columns_.count(column) != 0; }
  /// Throws StartupError where there is no such column.
  [[nodiscard]] const std::vector<double>& column(const std::string& name) const;

 private:
  std::string file_;
  std::size_t rows_ = 0;
  std::map<std::string, std::vector<double>> columns_;
};

}  // namespace jaywalk::bench
