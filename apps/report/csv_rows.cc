#include "apps/report/csv_rows.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "hal/types/errors.h"

namespace jaywalk {

std::vector<std::string> parts_between(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

CsvRows::CsvRows(const std::filesystem::path& file, const std::vector<std::string>& columns) : file_(file), in_(file) {
  std::string line;
  if (!std::getline(in_, line)) throw StartupError(file.string() + ": cannot be read", "give the folder of a run");
  const std::vector<std::string> names = parts_between(line, ',');
  columns_ = names.size();
  for (const std::string& column : columns) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end())
      throw StartupError(file.string() + ":1: has no column " + column, "give the folder of a run of this version");
    places_.push_back(static_cast<std::size_t>(found - names.begin()));
  }
}

void CsvRows::refuse() const {
  throw StartupError(file_.string() + ":" + std::to_string(line_) + ": no row of a run's table",
                     "give the folder that jaywalk wrote");
}

bool CsvRows::next() {
  std::string line;
  if (!std::getline(in_, line) || in_.eof()) return false;
  ++line_;
  cells_ = parts_between(line, ',');
  if (cells_.size() != columns_) refuse();
  return true;
}

double CsvRows::number(std::size_t k) const {
  const std::string& word = text(k);
  double value = std::numeric_limits<double>::quiet_NaN();
  if (word.empty()) return value;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) refuse();
  return value;
}

}  // namespace jaywalk
