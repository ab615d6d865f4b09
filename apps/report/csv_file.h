#pragma once
// Tables whose bytes depend on their numbers alone.
#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/recording/append_file.h"
#include "hal/types/time.h"

namespace jaywalk {

/// A comma-separated table: a header line, then rows cell by cell. Numbers have six decimals and a
/// point whatever the locale, zero has no sign, NaN is an empty cell, infinity is "inf". On a disk that is full it ends
/// with the last row that was taken whole.
class CsvFile {
 public:
  /// Throws StartupError when the file cannot be made.
  CsvFile(const std::string& file, std::string_view header);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  CsvFile& number(double value);
  CsvFile& count(std::uint64_t value);
  CsvFile& seconds(Time t);  ///< exact to the nanosecond before it is rounded to six decimals
  CsvFile& text(std::string_view value);
  void end_row();
  /// Between rows: writes out what there is. False when the disk did not take all of it, now or before.
  bool write_out();
  /// Writes out what is left. False likewise.
  bool close();
  /// AppendFile's, both.
  [[nodiscard]] bool has_failed() const noexcept { return file_.has_failed(); }
  [[nodiscard]] std::string complaint() const { return file_.complaint(); }
  /// Of the file, with what is not on the disk yet.
  [[nodiscard]] std::uintmax_t bytes() const noexcept { return file_.bytes() + rows_.size(); }

 private:
  void begin_cell();

  AppendFile file_;
  std::string rows_;
  bool row_begun_ = false;
};

/// `value` as a cell of a table shows it.
[[nodiscard]] std::string csv_cell(double value);

}  // namespace jaywalk
