#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace jaywalk::campaign {

/// Reads columns of a table that the program wrote (apps/report/csv_file.h), row by row. Memory: a row.
class CsvRows {
 public:
  /// Throws StartupError where `file` cannot be read or lacks one of `columns`.
  CsvRows(const std::filesystem::path& file, const std::vector<std::string>& columns);

  /// False at the end, or at a row that was cut short.
  [[nodiscard]] bool next();
  /// The row's cell of `columns[k]`.
  [[nodiscard]] const std::string& text(std::size_t k) const { return cells_[places_[k]]; }
  /// The same; NaN for an empty cell or what is no number.
  [[nodiscard]] double number(std::size_t k) const;

 private:
  std::ifstream in_;
  std::vector<std::size_t> places_;
  std::vector<std::string> cells_;
  std::size_t columns_ = 0;
};

}  // namespace jaywalk::campaign
