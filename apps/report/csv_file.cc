#include "apps/report/csv_file.h"

#include <array>
#include <charconv>
#include <cmath>

namespace jaywalk {
namespace {

constexpr std::size_t kBlockBytes = 1U << 16U;

}  // namespace

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

CsvFile::~CsvFile() { close(); }

bool CsvFile::close() {
  write_out();
  return file_.close();
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

void CsvFile::begin_cell() {
  if (row_begun_) rows_ += ',';
  row_begun_ = true;
}

CsvFile& CsvFile::number(double value) {
  begin_cell();
  rows_ += csv_cell(value);
  return *this;
}

CsvFile& CsvFile::count(std::uint64_t value) {
  begin_cell();
  rows_ += std::to_string(value);
  return *this;
}

CsvFile& CsvFile::seconds(Time t) {
  begin_cell();
  const std::int64_t ns = t.time_since_epoch().count();
  const std::int64_t us = ns / 1000 + (ns % 1000 >= 500 ? 1 : 0) - (ns % 1000 < -500 ? 1 : 0);
  const std::string fraction = std::to_string(std::abs(us % 1'000'000));
  if (us < 0 && us > -1'000'000) rows_ += '-';
  rows_ += std::to_string(us / 1'000'000) + "." + std::string(6 - fraction.size(), '0') + fraction;
  return *this;
}

CsvFile& CsvFile::text(std::string_view value) {
  begin_cell();
  rows_ += value;
  return *this;
}

void CsvFile::end_row() {
  rows_ += '\n';
  row_begun_ = false;
  if (rows_.size() >= kBlockBytes) write_out();
}

}  // namespace jaywalk
