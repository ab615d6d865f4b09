#pragma once
#include <array>
#include <string>
#include <vector>

#include "apps/campaign/report.h"
#include "apps/report/drive_metrics.h"

namespace jaywalk::campaign {

// Success against the number of movers: the paper's table 1, and the campaign's beside it.

/// Runs with so many movers.
struct SuccessPoint {
  double movers = 0.0;
  std::size_t good = 0;  ///< successes by the strict rule
  std::size_t runs = 0;  ///< finished ones, at least one
};

struct SuccessLine {
  std::string name;
  std::vector<SuccessPoint> points;
};

/// Success that the paper reports on its own maps.
struct PaperPoint {
  double movers, percent;
};
/// Time-warped grids, table "Percentage of success in path planning".
inline constexpr std::array<PaperPoint, 6> kPaper{{{1, 95}, {2, 95}, {4, 92.5}, {8, 87.5}, {12, 80}, {16, 75}}};

/// A line for each experiment that varies movers.count, and within it for each setting of what else varies.
[[nodiscard]] std::vector<SuccessLine> success_lines(const std::vector<ReportedTables>& all);

/// A row for each line, a column for each number of movers, and the paper's row; "-" where nothing was run.
[[nodiscard]] ReportTable success_table(const std::vector<SuccessLine>& lines);

/// Success against movers, with the paper's own points (its table 1) beside the lines; movers on a scale of doublings.
[[nodiscard]] std::string success_chart(const std::vector<SuccessLine>& lines);

struct TurnBars {
  std::string name;
  std::array<double, kTurnBins> shares{};  ///< of all turns
};

/// The paper's histograms of turning angles, one beside the other; heights are shares on a scale of tenfolds, so that
/// rare wide turns are seen.
[[nodiscard]] std::string turn_chart(const std::vector<TurnBars>& all);

/// A map with its runs.
struct MapPanel {
  struct Run {
    std::size_t row = 0;  ///< of the experiment's rows
    double value = 0.0;   ///< NaN: did not arrive
    std::string said;     ///< names it
  };
  std::string map;
  std::vector<Run> runs;
};

/// A small panel a map, all with the same axes: a column a row of the experiment, a dot a run; an open dot at the top
/// did not arrive.
[[nodiscard]] std::string map_chart(const std::vector<MapPanel>& panels);

}  // namespace jaywalk::campaign
