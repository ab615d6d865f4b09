#include "apps/report/csv_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
constexpr std::size_t kBlockBytes = 1U << 16U;

std::string csv_cell(double value) {
  if (std::isnan(value)) return "";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 400> digits{};  // DBL_MAX has 309 before the point
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, 6).ptr;
  const std::string_view text(digits.data(), static_cast<std::size_t>(end - digits.data()));
  return std::string(text == "-0.000000" ? text.substr(1) : text);
}

CsvFile::CsvFile(const std::string& file, std::string_view header) : file_(file) {
  rows_.reserve(kBlockBytes + 1024);
  rows_.append(header).append("\n");
}

bool CsvFile::write_out() {
  const std::size_t taken = file_.append({reinterpret_cast<const unsigned char*>(rows_.data()), rows_.size()});
  if (taken < rows_.size()) {
    const std::size_t last_end = taken == 0 ? std::string::npos : rows_.rfind('\n', taken - 1);
    file_.take_back(last_end == std::string::npos ? taken : taken - (last_end + 1));
  }
  rows_.clear();
  return !file_.has_failed();
}

CsvFile& CsvFile::seconds(Time t) {
  const std::int64_t ns = t.time_since_epoch().count();
  const std::int64_t us = ns / 1000 + (ns % 1000 >= 500 ? 1 : 0) - (ns % 1000 < -500 ? 1 : 0);
  return text(formatted("%s%lld.%06lld", us < 0 ? "-" : "", std::llabs(us / 1'000'000), std::llabs(us % 1'000'000)));
}

void CsvFile::end_row() {
  rows_ += '\n';
  row_begun_ = false;
  if (rows_.size() >= kBlockBytes) write_out();
}

std::vector<std::string> parts_between(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream rest(text + at);
  for (std::string part; std::getline(rest, part, at);) parts.push_back(part);
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
  const auto value = number_in<double>(word);
  if (!value && !word.empty()) refuse();
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace jaywalk
