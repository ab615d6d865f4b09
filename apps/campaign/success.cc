#include "apps/campaign/success.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "apps/campaign/statistics.h"

namespace jaywalk::campaign {
namespace {

constexpr const char* kMovers = "movers.count";

double number_of(const std::string& word) {
  double value = 0.0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

/// What a line is called: the experiment, and the values of the other axes that vary.
std::string line_name(const ReportedTables& tables, const ReportedRow& row, std::size_t movers) {
  std::string name;
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    const bool varies = std::any_of(tables.rows.begin(), tables.rows.end(),
                                    [&](const ReportedRow& other) { return other.values[k] != row.values[k]; });
    if (k != movers && varies) name += ", " + tables.experiment->axes[k] + " " + row.values[k];
  }
  return tables.experiment->title + name;
}

SuccessPoint point_of(const ReportedRow& row, std::size_t movers) {
  const auto good = std::count_if(row.runs.begin(), row.runs.end(), [](const auto& r) { return r.result.success; });
  return {number_of(row.values[movers]), static_cast<std::size_t>(good), row.runs.size()};
}

/// "11 of 12" of the points with so many movers (several where the same number stands twice in a line).
std::string cell_of(const SuccessLine& line, double movers) {
  SuccessPoint sum{movers, 0, 0};
  for (const SuccessPoint& point : line.points) {
    if (point.movers == movers) sum.good += point.good, sum.runs += point.runs;
  }
  return sum.runs == 0 ? "-" : std::to_string(sum.good) + " of " + std::to_string(sum.runs);
}

std::string papers_cell(double movers) {
  const auto point = std::find_if(kPaper.begin(), kPaper.end(), [&](const auto& p) { return p.movers == movers; });
  return point == kPaper.end() ? "-" : fixed(point->percent, 1) + " %";
}

}  // namespace

std::vector<SuccessLine> success_lines(const std::vector<ReportedTables>& all) {
  std::vector<SuccessLine> lines;
  for (const ReportedTables& tables : all) {
    const auto& axes = tables.experiment->axes;
    const auto movers = static_cast<std::size_t>(std::find(axes.begin(), axes.end(), kMovers) - axes.begin());
    if (movers == axes.size()) continue;
    for (const ReportedRow& row : tables.rows) {
      if (row.runs.empty()) continue;
      const std::string name = line_name(tables, row, movers);
      auto line = std::find_if(lines.begin(), lines.end(), [&](const SuccessLine& l) { return l.name == name; });
      if (line == lines.end()) line = lines.insert(lines.end(), {name, {}});
      line->points.push_back(point_of(row, movers));
    }
  }
  return lines;
}

ReportTable success_table(const std::vector<SuccessLine>& lines) {
  std::set<double> counts;
  for (const SuccessLine& line : lines) {
    for (const SuccessPoint& point : line.points) counts.insert(point.movers);
  }
  ReportTable table{"Success, by movers", {""}, {}};
  for (const double movers : counts) table.head.push_back(fixed(movers, 0));
  for (const SuccessLine& line : lines) {
    table.rows.push_back({line.name});
    for (const double movers : counts) table.rows.back().push_back(cell_of(line, movers));
  }
  table.rows.push_back({"the paper, on its own maps"});
  for (const double movers : counts) table.rows.back().push_back(papers_cell(movers));
  return table;
}

}  // namespace jaywalk::campaign
