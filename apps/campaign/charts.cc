#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "apps/campaign/report.h"
#include "apps/campaign/statistics.h"
#include "apps/report/markup.h"
#include "hal/types/geometry.h"

namespace jaywalk::campaign {
namespace {

constexpr const char* kMovers = "movers.count";

double number_of(const std::string& word) {
  double value = 0.0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

/// Name of a line: its experiment, and the values of the other axes that vary.
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
  for (const SuccessPoint& point : line.points)
    if (point.movers == movers) sum.good += point.good, sum.runs += point.runs;
  return sum.runs == 0 ? "-" : std::to_string(sum.good) + " of " + std::to_string(sum.runs);
}

std::string papers_cell(double movers) {
  const auto point = std::find_if(kPaper.begin(), kPaper.end(), [&](const auto& p) { return p.movers == movers; });
  return point == kPaper.end() ? "-" : fixed(point->percent, 1) + " %";
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

/// Text that a browser shows while the pointer is on an element.
std::string hover(const std::string& text) { return "<title>" + as_markup(text) + "</title>"; }

std::string dot(double movers, double share, const std::string& colour, bool open, const std::string& said) {
  return "<circle cx=\"" + fixed(x_of(movers), 1) + "\" cy=\"" + fixed(y_of(share), 1) + "\" r=\"5\" fill=\"" +
         (open ? "#fff" : colour) + "\" stroke=\"" + colour + "\" stroke-width=\"2\">" +
         hover(said + ", " + fixed(movers, 0) + " movers: " + fixed(100.0 * share, 1) + " %") + "</circle>\n";
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

/// 1, 2 or 5 times a power of ten: a quarter of `most` or the next larger.
double step_of(double most) {
  const double tenfold = std::pow(10.0, std::floor(std::log10(most / 4.0)));
  for (const double step : {tenfold, 2.0 * tenfold, 5.0 * tenfold})
    if (step >= most / 4.0) return step;
  return 10.0 * tenfold;
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
  for (const PaperPoint& point : kPaper) out += dot(point.movers, point.percent / 100.0, "#111", true, "the paper");
  return out + text_at(kLeft + 12.0, y, "o", "middle") +
         text_at(kLeft + 32.0, y, "the paper, on its own maps", "start") + "</svg>\n";
}

std::string turn_chart(const std::vector<TurnBars>& all) {
  constexpr double kBar = kPanelWide / static_cast<double>(kTurnBins), kTenfolds = 4.0;
  std::string out = opened_panels(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto [x, foot] = foot_of(k);
    for (std::size_t bin = 0; bin < kTurnBins; ++bin) {
      const double share = all[k].shares[bin];
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
           text_at(x + kPanelWide, foot + 14.0, "180") + text_at(x + kPanelWide / 2.0, foot + 30.0, all[k].name);
  }
  return out + "</svg>\n";
}

std::string map_chart(const std::vector<MapPanel>& panels) {
  double most = 1.0, rows = 1.0;
  for (const MapPanel& panel : panels)
    for (const MapPanel::Run& run : panel.runs)
      most = std::fmax(most, run.value), rows = std::max(rows, static_cast<double>(run.row + 1));
  const double step = step_of(most), top = step * std::ceil(most / step);
  std::string out = opened_panels(panels.size());
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Vec2 foot = foot_of(k);
    const auto y_at = [&](double value) { return foot.y - kPanelHigh * std::clamp(value / top, 0.0, 1.0); };
    for (double tick = 0.0; tick < top + step / 2.0; tick += step)
      out += line_of(foot.x, y_at(tick), foot.x + kPanelWide, y_at(tick), "#ccc") +
             text_at(foot.x - 6.0, y_at(tick) + 4.0, fixed(tick, step < 1.0 ? 1 : 0), "end");
    for (const MapPanel::Run& run : panels[k].runs) {
      const std::string colour = kColours[run.row % kColours.size()];
      const bool arrived = !std::isnan(run.value);
      out += "<circle cx=\"" + fixed(foot.x + kPanelWide * (static_cast<double>(run.row) + 0.5) / rows, 1) +
             "\" cy=\"" + fixed(arrived ? y_at(run.value) : foot.y - kPanelHigh, 1) + "\" r=\"4\" fill=\"" +
             (arrived ? colour : "#fff") + "\" stroke=\"" + colour + "\">" +
             hover(run.said + ": " + (arrived ? fixed(run.value, 1) : "did not arrive")) + "</circle>\n";
    }
    out += text_at(foot.x + kPanelWide / 2.0, foot.y + 20.0, panels[k].map);
  }
  return out + "</svg>\n";
}

}  // namespace jaywalk::campaign
