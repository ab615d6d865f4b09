#pragma once
// CSV tables, written and read. Equal numbers give equal bytes, on every machine.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/recording/recorder.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// `value` as a cell of a table shows it: six decimals and a point whatever the locale, zero without a sign, NaN empty,
/// infinity "inf".
[[nodiscard]] std::string csv_cell(double value);

/// A comma-separated table: a header line, then rows cell by cell. On a disk that is full it ends with the last row
/// that was taken whole.
class CsvFile {
 public:
  /// Throws StartupError when the file cannot be made.
  CsvFile(const std::string& file, std::string_view header);
  ~CsvFile() { close(); }

  CsvFile& number(double value) { return text(csv_cell(value)); }
  CsvFile& count(std::uint64_t value) { return text(std::to_string(value)); }
  CsvFile& vector(Vec2 v) { return number(v.x).number(v.y); }
  CsvFile& pose(const Pose2& pose) { return vector(pose.position()).number(pose.heading); }
  CsvFile& seconds(Time t);  ///< exact to the nanosecond before it is rounded to six decimals
  CsvFile& text(std::string_view value) {
    if (std::exchange(row_begun_, true)) rows_ += ',';
    rows_ += value;
    return *this;
  }
  void end_row();
  /// Between rows: writes out what there is. False when the disk did not take all of it, now or before.
  bool write_out();
  /// Writes out what is left. False likewise.
  bool close() {
    write_out();
    return file_.close();
  }
  [[nodiscard]] std::string complaint() const { return file_.complaint(); }
  /// Of the file, with what is not on the disk yet.
  [[nodiscard]] std::uintmax_t bytes() const noexcept { return file_.bytes() + rows_.size(); }

 private:
  AppendFile file_;
  std::string rows_;
  bool row_begun_ = false;
};

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
