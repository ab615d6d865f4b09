#pragma once
// Tables whose bytes depend on their numbers alone.
#include <fstream>
#include <string>
#include <string_view>

#include "hal/types/time.h"

namespace jaywalk {

/// A comma-separated table: a header line, then rows cell by cell. Numbers have six decimals and a
/// point whatever the locale, zero has no sign, NaN is an empty cell, infinity is "inf".
class CsvFile {
 public:
  /// Throws StartupError when the file cannot be written.
  CsvFile(const std::string& file, std::string_view header);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  CsvFile& number(double value);
  CsvFile& count(std::uint64_t value);
  CsvFile& seconds(Time t);  ///< exact to the nanosecond before it is rounded to six decimals
  CsvFile& text(std::string_view value);
  void end_row();
  /// Writes out what is left. Throws StartupError when the disk did not take all of it, now or before.
  void close();

 private:
  void begin_cell();
  void write_out();

  std::string file_;
  std::ofstream stream_;
  std::string rows_;
  bool row_begun_ = false;
};

/// `value` as a cell of a table shows it.
[[nodiscard]] std::string csv_cell(double value);

}  // namespace jaywalk
