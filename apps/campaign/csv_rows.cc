#include "apps/campaign/csv_rows.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "hal/types/errors.h"

namespace jaywalk::campaign {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

}  // namespace

CsvRows::CsvRows(const std::filesystem::path& file, const std::vector<std::string>& columns) : in_(file) {
  std::string line;
  if (!std::getline(in_, line)) throw StartupError(file.string() + ": cannot be read", "give a run's folder");
  const std::vector<std::string> names = cells_of(line);
  columns_ = names.size();
  for (const std::string& column : columns) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end())
      throw StartupError(file.string() + ":1: has no column " + column, "give a table of this program");
    places_.push_back(static_cast<std::size_t>(found - names.begin()));
  }
}

bool CsvRows::next() {
  std::string line;
  if (!std::getline(in_, line)) return false;
  cells_ = cells_of(line);
  return cells_.size() == columns_;
}

double CsvRows::number(std::size_t k) const {
  const std::string& word = text(k);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jaywalk::campaign
