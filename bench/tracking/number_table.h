#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace jaywalk::bench {

/// A comma-separated table, plain or .gz, with names of columns in the first line. Columns are looked at when asked
/// for: others may hold words. Everything throws StartupError "FILE:LINE: cause; remedy".
class NumberTable {
 public:
  /// Throws for what cannot be read, has no first line, or has a row of more or fewer cells than that.
  explicit NumberTable(const std::filesystem::path& file);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] bool has(std::string_view column) const;
  /// Throws where there is no such column, and for a cell that is no number of a place, time or speed.
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  /// The same; NaN for cells that are empty or "nan": what nobody knows.
  [[nodiscard]] std::vector<double> column_where_known(std::string_view name) const;
  /// Whole numbers from 0 on that fit into 32 bits.
  [[nodiscard]] std::vector<std::uint32_t> names(std::string_view column) const;

 private:
  struct Row {
    std::size_t line = 0;
    std::string text;
  };
  [[nodiscard]] std::size_t place_of(std::string_view column) const;
  [[nodiscard]] double number_in(const Row& row, std::string_view cell, std::string_view column) const;
  [[noreturn]] void refuse(std::size_t line, const std::string& cause, const std::string& remedy) const;

  std::string file_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace jaywalk::bench
