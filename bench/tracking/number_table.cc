#include "bench/tracking/number_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "apps/formats/logs/line_file.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::bench {
namespace {

constexpr double kMost = 1e10;  // seconds since 1970 are 2e9

/// Cell `k` of a line, without blanks round it; the line has that many.
std::string_view cell_of(std::string_view line, std::size_t k) {
  for (; k > 0; --k) line.remove_prefix(line.find(',') + 1);
  const std::string_view cell = line.substr(0, line.find(','));
  const std::size_t first = cell.find_first_not_of(" \t"), last = cell.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : cell.substr(first, last + 1 - first);
}

std::size_t cells_in(std::string_view line) {
  return 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
}

}  // namespace

NumberTable::NumberTable(const std::filesystem::path& file) : file_(file.string()) {
  sim::TextLines lines(file, "give a table, .csv or .csv.gz");
  if (!lines.next() || lines.text().empty()) refuse(1, "no names of columns", "the first line names the columns");
  for (std::size_t k = 0; k < cells_in(lines.text()); ++k) columns_.emplace_back(cell_of(lines.text(), k));
  while (lines.next()) {
    if (lines.text().empty()) continue;
    if (const std::size_t cells = cells_in(lines.text()); cells != columns_.size()) {
      refuse(lines.line(), std::to_string(cells) + " cells", "give one a column, " + std::to_string(columns_.size()));
    }
    rows_.push_back({lines.line(), lines.text()});
  }
}

void NumberTable::refuse(std::size_t line, const std::string& cause, const std::string& remedy) const {
  throw StartupError(file_ + ":" + std::to_string(line) + ": " + cause, remedy);
}

bool NumberTable::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t NumberTable::place_of(std::string_view column) const {
  if (!has(column)) refuse(1, "no column \"" + std::string(column) + "\"", "name it in the first line");
  return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) - columns_.begin());
}

double NumberTable::number_in(const Row& row, std::string_view cell, std::string_view column) const {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !(std::fabs(value) <= kMost)) {
    refuse(row.line, "'" + shown(cell) + "' in the column " + std::string(column), "give metres and seconds");
  }
  return value;
}

std::vector<double> NumberTable::column(std::string_view name) const {
  const std::size_t place = place_of(name);
  std::vector<double> values;
  for (const Row& row : rows_) values.push_back(number_in(row, cell_of(row.text, place), name));
  return values;
}

std::vector<double> NumberTable::column_where_known(std::string_view name) const {
  const std::size_t place = place_of(name);
  std::vector<double> values;
  for (const Row& row : rows_) {
    const std::string_view cell = cell_of(row.text, place);
    const bool unknown = cell.empty() || cell == "nan";
    values.push_back(unknown ? std::numeric_limits<double>::quiet_NaN() : number_in(row, cell, name));
  }
  return values;
}

std::vector<std::uint32_t> NumberTable::names(std::string_view column) const {
  const std::size_t place = place_of(column);
  std::vector<std::uint32_t> values;
  for (const Row& row : rows_) {
    const std::string_view cell = cell_of(row.text, place);
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), values.emplace_back());
    if (error == std::errc() && end == cell.data() + cell.size()) continue;
    refuse(row.line, "'" + shown(cell) + "' in the column " + std::string(column), "give whole numbers from 0 on");
  }
  return values;
}

}  // namespace jaywalk::bench
