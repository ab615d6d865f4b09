#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "apps/campaign/report.h"
#include "apps/report/markup.h"
#include "hal/shown_text.h"
#include "hal/types/geometry.h"

namespace jaywalk::campaign {
namespace {

constexpr const char* kMovers = "movers.count";

/// Movers, and success (%) that the paper reports on its own maps: time-warped grids, table "Percentage of success in
/// path planning".
constexpr std::array<std::pair<double, double>, 6> kPaper{{{1, 95}, {2, 95}, {4, 92.5}, {8, 87.5}, {12, 80}, {16, 75}}};

/// Name of a line: its experiment, and the values of the other axes that vary.
std::string line_name(const ReportedTables& tables, const ReportedRow& row, std::size_t movers) {
  std::string name;
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    const bool varies = std::ranges::any_of(tables.rows, [&](const auto& r) { return r.values[k] != row.values[k]; });
    if (k != movers && varies) name += ", " + tables.experiment->axes[k] + " " + row.values[k];
  }
  return tables.experiment->title + name;
}

SuccessPoint point_of(const ReportedRow& row, std::size_t movers) {
  const auto good = std::count_if(row.runs.begin(), row.runs.end(), [](const auto& r) { return r.result.success; });
  return {number_in<double>(row.values[movers]).value_or(0.0), static_cast<std::size_t>(good), row.runs.size()};
}

/// "11 of 12" of the points with so many movers (several where the same number stands twice in a line).
std::string cell_of(const SuccessLine& line, double movers) {
  SuccessPoint sum{movers, 0, 0};
  for (const SuccessPoint& point : line.points)
    if (point.movers == movers) sum.good += point.good, sum.runs += point.runs;
  return sum.runs == 0 ? "-" : std::to_string(sum.good) + " of " + std::to_string(sum.runs);
}

std::string papers_cell(double movers) {
  const auto point = std::ranges::find(kPaper, movers, &std::pair<double, double>::first);
  return point == kPaper.end() ? "-" : fixed(point->second, 1) + " %";
}

constexpr std::array kColours{"#0a6e8a", "#c2410c", "#4d7c0f", "#7c3aed", "#eab308", "#be185d", "#334155", "#0f766e"};
constexpr double kLeft = 60.0, kTop = 20.0, kWide = 700.0, kHigh = 360.0;
constexpr double kMostDoublings = 6.5;                                 // 64 movers, and some room
constexpr double kPanelWide = 180.0, kPanelHigh = 130.0, kGap = 80.0;  // of small charts
constexpr std::size_t kAcross = 4;

std::string opened(double width, double height) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(width, 0) + " " + fixed(height, 0) +
         "\" width=\"" + fixed(width, 0) +
         "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#333\">\n<rect width=\"" + fixed(width, 0) +
         "\" height=\"" + fixed(height, 0) + "\" fill=\"#fff\"/>\n";
}

std::string text_at(double x, double y, const std::string& text, const char* anchor = "middle") {
  return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor + "\">" + as_markup(text) +
         "</text>\n";
}

std::string line_of(double x1, double y1, double x2, double y2, const std::string& colour, double width = 1.0) {
  return "<line x1=\"" + fixed(x1, 1) + "\" y1=\"" + fixed(y1, 1) + "\" x2=\"" + fixed(x2, 1) + "\" y2=\"" +
         fixed(y2, 1) + "\" stroke=\"" + colour + "\" stroke-width=\"" + fixed(width, 1) + "\"/>\n";
}

/// None at the left edge, one next to it, then a step for each doubling.
double x_of(double movers) {
  const double step = movers < 1.0 ? 0.0 : 0.6 + std::log2(movers);
  return kLeft + kWide * std::min(step, kMostDoublings + 0.6) / (kMostDoublings + 0.6);
}

double y_of(double share) { return kTop + kHigh * (1.0 - share); }

/// A text shown while the pointer is on an element.
std::string hover(const std::string& text) { return "<title>" + as_markup(text) + "</title>"; }

std::string circle(Vec2 at, int radius, const std::string& colour, bool open, const std::string& said,
                   const char* rim = "") {
  return "<circle cx=\"" + fixed(at.x, 1) + "\" cy=\"" + fixed(at.y, 1) + "\" r=\"" + std::to_string(radius) +
         "\" fill=\"" + (open ? "#fff" : colour) + "\" stroke=\"" + colour + "\"" + rim + ">" + hover(said) +
         "</circle>\n";
}

std::string dot(double movers, double share, const std::string& colour, bool open, const std::string& said) {
  return circle({x_of(movers), y_of(share)}, 5, colour, open,
                said + ", " + fixed(movers, 0) + " movers: " + fixed(100.0 * share, 1) + " %", " stroke-width=\"2\"");
}

std::string success_axes() {
  std::string out;
  for (int percent = 0; percent <= 100; percent += 20) {
    const double y = y_of(percent / 100.0);
    out += line_of(kLeft, y, kLeft + kWide, y, "#e5e5e5") +
           text_at(kLeft - 8.0, y + 4.0, std::to_string(percent) + " %", "end");
  }
  for (const double movers : {0.0, 1.0, 2.0, 4.0, 8.0, 12.0, 16.0, 32.0, 64.0})
    out += text_at(x_of(movers), kTop + kHigh + 20.0, fixed(movers, 0));
  return out + text_at(kLeft + kWide / 2.0, kTop + kHigh + 42.0, "movers");
}

double share_of(const SuccessPoint& point) { return static_cast<double>(point.good) / static_cast<double>(point.runs); }

std::string line_through(const SuccessLine& line, const std::string& colour) {
  std::string out;
  const SuccessPoint* before = nullptr;
  for (const SuccessPoint& point : line.points) {
    const double x = x_of(point.movers);
    const Interval interval = wilson(point.good, point.runs);
    if (before != nullptr)
      out += line_of(x_of(before->movers), y_of(share_of(*before)), x, y_of(share_of(point)), colour, 2.0);
    out += line_of(x, y_of(interval.low), x, y_of(interval.high), colour) +
           dot(point.movers, share_of(point), colour, false,
               line.name + ", " + std::to_string(point.good) + " of " + std::to_string(point.runs));
    before = &point;
  }
  return out;
}

std::string opened_panels(std::size_t panels) {
  const std::size_t rows = (panels + kAcross - 1) / kAcross;
  return opened((kPanelWide + kGap) * static_cast<double>(kAcross) + kGap,
                (kPanelHigh + 60.0) * static_cast<double>(rows));
}

/// Left end of a panel's foot.
Vec2 foot_of(std::size_t panel) {
  return {kGap + (kPanelWide + kGap) * static_cast<double>(panel % kAcross),
          (kPanelHigh + 60.0) * static_cast<double>(panel / kAcross) + 20.0 + kPanelHigh};
}

/// A run of `row` of the tables.
std::string lost_dot(double x, double y, std::size_t row, const std::string& name, const ReportedRun& run) {
  const double lost_s = time_lost_s(run);
  const bool arrived = !std::isnan(lost_s);
  return circle(
      {x, y}, 4, kColours[row % kColours.size()], !arrived,
      name + ", seed " + std::to_string(run.run->seed) + ": " + (arrived ? fixed(lost_s, 1) : "did not arrive"));
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
  for (const SuccessLine& line : lines)
    for (const SuccessPoint& point : line.points) counts.insert(point.movers);
  ReportTable table = table_with(
      "Success, by movers", lines, counts, [](double movers) { return fixed(movers, 0); }, cell_of);
  table.rows.push_back({"the paper, on its own maps"});
  for (const double movers : counts) table.rows.back().push_back(papers_cell(movers));
  return table;
}

std::string success_chart(const std::vector<SuccessLine>& lines) {
  const double legend_y = kTop + kHigh + 60.0;
  std::string out = opened(kLeft + kWide + 20.0, legend_y + 22.0 * static_cast<double>(lines.size() + 1));
  out += success_axes();
  double y = legend_y + 8.0;
  for (std::size_t k = 0; k < lines.size(); ++k, y += 22.0) {
    const std::string colour = kColours[k % kColours.size()];
    out += line_through(lines[k], colour) + line_of(kLeft, y - 4.0, kLeft + 24.0, y - 4.0, colour, 2.0) +
           text_at(kLeft + 32.0, y, lines[k].name, "start");
  }
  for (const auto& [movers, percent] : kPaper) out += dot(movers, percent / 100.0, "#111", true, "the paper");
  return out + text_at(kLeft + 12.0, y, "o", "middle") +
         text_at(kLeft + 32.0, y, "the paper, on its own maps", "start") + "</svg>\n";
}

std::string turn_chart(const std::vector<ReportedRow>& rows) {
  constexpr double kBar = kPanelWide / static_cast<double>(kTurnBins), kTenfolds = 4.0;
  std::string out = opened_panels(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto [x, foot] = foot_of(k);
    const std::vector<double> turns = turns_of(rows[k]);
    const double all = std::accumulate(turns.begin(), turns.end(), 0.0);
    for (std::size_t bin = 0; bin < kTurnBins; ++bin) {
      const double share = all > 0.0 ? turns[bin] / all : 0.0;
      const double high = share > 0.0 ? kPanelHigh * std::max(0.02, 1.0 + std::log10(share) / kTenfolds) : 0.0;
      out += "<rect x=\"" + fixed(x + kBar * static_cast<double>(bin), 1) + "\" y=\"" + fixed(foot - high, 1) +
             "\" width=\"" + fixed(kBar - 1.0, 1) + "\" height=\"" + fixed(high, 1) + "\" fill=\"#0a6e8a\">" +
             hover(std::to_string(10 * bin) + " to " + std::to_string(10 * bin + 10) +
                   " degrees: " + fixed(100.0 * share, 2) + " %") +
             "</rect>\n";
    }
    for (int tenfold = 0; tenfold <= 4; tenfold += 2) {
      const double y = foot - kPanelHigh * (1.0 - tenfold / kTenfolds);
      out += line_of(x - 4.0, y, x, y, "#333") +
             text_at(x - 6.0, y + 4.0, fixed(100.0 * std::pow(10.0, -tenfold), tenfold == 4 ? 2 : 0) + " %", "end");
    }
    out += line_of(x, foot, x + kPanelWide, foot, "#333") + text_at(x, foot + 14.0, "0") +
           text_at(x + kPanelWide, foot + 14.0, "180") + text_at(x + kPanelWide / 2.0, foot + 30.0, rows[k].name);
  }
  return out + "</svg>\n";
}

std::string map_chart(const ReportedTables& tables) {
  const std::vector<std::string>& maps = tables.experiment->scenarios;
  if (maps.size() < 2 || maps.size() > kMostColumns) return "";
  double most = 1.0, columns = 1.0;
  for (std::size_t row = 0; row < tables.rows.size(); ++row)
    for (const ReportedRun& run : tables.rows[row].runs)
      most = std::fmax(most, time_lost_s(run)), columns = static_cast<double>(row + 1);
  const double step = round_length(most / 4.0), top = step * std::ceil(most / step);
  std::string out = opened_panels(maps.size());
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const Vec2 foot = foot_of(k);
    const auto y_at = [&](double value) { return foot.y - kPanelHigh * std::clamp(value / top, 0.0, 1.0); };
    for (double tick = 0.0; tick < top + step / 2.0; tick += step)
      out += line_of(foot.x, y_at(tick), foot.x + kPanelWide, y_at(tick), "#ccc") +
             text_at(foot.x - 6.0, y_at(tick) + 4.0, fixed(tick, step < 1.0 ? 1 : 0), "end");
    for (std::size_t row = 0; row < tables.rows.size(); ++row) {
      const double x = foot.x + kPanelWide * (static_cast<double>(row) + 0.5) / columns;
      for (const ReportedRun& run : tables.rows[row].runs)
        if (run.run->scenario == maps[k])
          out += lost_dot(x, std::isnan(time_lost_s(run)) ? foot.y - kPanelHigh : y_at(time_lost_s(run)), row,
                          tables.rows[row].name, run);
    }
    out += text_at(foot.x + kPanelWide / 2.0, foot.y + 20.0, maps[k]);
  }
  return out + "</svg>\n";
}

}  // namespace jaywalk::campaign
