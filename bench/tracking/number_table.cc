#include "bench/tracking/number_table.h"

#include <zlib.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "hal/types/errors.h"

namespace jaywalk::bench {
namespace {

double number_in(const std::string& cell) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  return end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : value;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<std::string> lines_of(const std::string& file) {
  const gzFile in = gzopen(file.c_str(), "rb");
  if (in == nullptr) throw StartupError(file + ": cannot be read", "give a table, .csv or .csv.gz");
  std::string text;
  std::array<char, 1 << 16> block{};
  for (int n = 0; (n = gzread(in, block.data(), block.size())) > 0;)
    text.append(block.data(), static_cast<std::size_t>(n));
  gzclose(in);
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

NumberTable::NumberTable(const std::filesystem::path& file) : file_(file.string()) {
  const std::vector<std::string> lines = lines_of(file_);
  if (lines.empty()) throw StartupError(file_ + ":1: no names of columns", "the first line names the columns");
  const std::vector<std::string> names = cells_of(lines.front());
  for (std::size_t row = 1; row < lines.size(); ++row) {
    const std::vector<std::string> cells = cells_of(lines[row]);
    if (cells.size() + 1 < names.size()) {  // an empty last cell leaves nothing behind its comma
      throw StartupError(file_ + ":" + std::to_string(row + 1) + ": " + std::to_string(cells.size()) + " cells",
                         "give one a column, " + std::to_string(names.size()));
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      columns_[names[k]].push_back(k < cells.size() ? number_in(cells[k]) : std::numeric_limits<double>::quiet_NaN());
    }
  }
  for (const std::string& name : names) columns_[name];
  rows_ = lines.size() - 1;
}

const std::vector<double>& NumberTable::column(const std::string& name) const {
  const auto found = columns_.find(name);
  if (found == columns_.end())
    throw StartupError(file_ + ":1: no column \"" + name + "\"", "name it in the first line");
  return found->second;
}

}  // namespace jaywalk::bench
