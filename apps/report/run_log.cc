#include "apps/report/run_log.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// An empty cell is a number that nobody knows.
bool read(const std::string& cell, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (cell.empty()) return true;
  const auto [rest, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return rest == cell.data() + cell.size() && error == std::errc{};
}

}  // namespace

RunLog::RunLog(const std::filesystem::path& file) : file_(file), in_(file) {
  std::string header;
  if (!std::getline(in_, header)) throw StartupError(file.string() + ": cannot be read", "give the folder of a run");
  const std::vector<std::string> names = split(header, ',');
  columns_ = names.size();
  t_ = column(names, "t_s");
  x_ = column(names, "est_x_m");
  y_ = column(names, "est_y_m");
  heading_ = column(names, "est_heading_rad");
  left_ = column(names, "left_radps");
  right_ = column(names, "right_radps");
  reasons_ = column(names, "reasons");
}

std::size_t RunLog::column(const std::vector<std::string>& names, const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw StartupError(file_.string() + ":1: has no column " + name, "give the folder of a run of this version");
  return static_cast<std::size_t>(found - names.begin());
}

bool RunLog::next(RunRow& row) {
  std::string text;
  if (!std::getline(in_, text) || in_.eof()) return false;  // without its line's end it was cut short
  ++line_;
  const std::vector<std::string> cells = split(text, ',');
  double left = 0.0, right = 0.0;
  Pose2& pose = row.map_from_robot;
  if (cells.size() != columns_ || !read(cells[t_], row.t_s) || !read(cells[x_], pose.x) || !read(cells[y_], pose.y) ||
      !read(cells[heading_], pose.heading) || !read(cells[left_], left) || !read(cells[right_], right))
    throw StartupError(file_.string() + ":" + std::to_string(line_) + ": no row of a run's table",
                       "give the folder that jaywalk wrote");
  row.stands = left == 0.0 && right == 0.0;
  row.reasons = cells[reasons_].empty() ? std::vector<std::string>() : split(cells[reasons_], '|');
  return true;
}

}  // namespace jaywalk
