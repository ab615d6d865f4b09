#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace jaywalk {

/// The parts of `text` between the letters `at`; one more than there are such letters.
[[nodiscard]] std::vector<std::string> parts_between(const std::string& text, char at);

/// Reads columns of a table that the program wrote (csv_file.h), row by row. Memory: a row.
class CsvRows {
 public:
  /// Throws StartupError where `file` cannot be read or lacks one of `columns`.
  CsvRows(const std::filesystem::path& file, const std::vector<std::string>& columns);

  /// False at the end; a last row without its line's end was cut short and is the end. Throws StartupError "FILE:LINE:
  /// cause; remedy" for a row of other cells than the first line names.
  [[nodiscard]] bool next();
  /// The row's cell of `columns[k]`.
  [[nodiscard]] const std::string& text(std::size_t k) const { return cells_[places_[k]]; }
  /// The same; NaN for an empty cell. Throws as next() does for what is no number.
  [[nodiscard]] double number(std::size_t k) const;

 private:
  [[noreturn]] void refuse() const;

  std::filesystem::path file_;
  std::ifstream in_;
  std::vector<std::size_t> places_;
  std::vector<std::string> cells_;
  std::size_t columns_ = 0, line_ = 1;
};

}  // namespace jaywalk
