#pragma once
#include <array>
#include <string>
#include <vector>

#include "apps/campaign/success.h"
#include "apps/report/drive_metrics.h"

namespace jaywalk::campaign {

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
