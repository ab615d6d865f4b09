#pragma once
// The report of a campaign from the folders of its shards: figures and pictures first, then HTML and Markdown, which
// say the same.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/campaign/campaign_folder.h"
#include "apps/report/drive_metrics.h"

namespace jaywalk::campaign {

struct ReportTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

struct ReportChart {
  std::string name;  ///< of its file, without ".svg"
  std::string title;
  std::string svg;
};

struct ReportFailure {
  std::string run;     ///< its folder below the campaign's: "movers/movers.count=16/map1_16/101"
  std::string what;    ///< "forced_mover at 34.2 s: mover 7 had to turn for the robot, ..."
  std::string repeat;  ///< the command, in the campaign file's folder
  std::string why;     ///< the command that explains the moment; empty where there is none
  std::string svg;     ///< the moving picture; empty where there is none
};

struct ReportSection {
  std::string title;
  std::string text;
  std::vector<ReportTable> tables;
  std::vector<ReportChart> charts;
};

/// A figure that is read first.
struct ReportCard {
  std::string figure;  ///< "94.0 %"
  std::string what;
};

struct ReportPage {
  std::string title;
  std::string text;
  std::vector<ReportCard> cards;
  std::vector<ReportSection> sections;
  std::vector<ReportFailure> failures;
  ReportTable runs;  ///< those that are finished; the first cell is the folder below the campaign's
};

/// One file that needs no other: charts, pictures and tables to download are in it. Its links to the runs' folders hold
/// where it lies in a folder of the campaign's.
[[nodiscard]] std::string html_of(const ReportPage& page);
/// Refers to charts beside it (charts/NAME.svg) and to pictures (failures/NUMBER.svg, from 1).
[[nodiscard]] std::string markdown_of(const ReportPage& page);

struct MapPanel;

/// A run of the plan and what came of it.
struct ReportedRun {
  const PlannedRun* run = nullptr;
  const std::string* command = nullptr;
  RunResult result;
  std::filesystem::path folder;
};

/// Runs with the same settings: a row of the tables.
struct ReportedRow {
  std::string name;
  std::vector<std::string> values;  ///< of the experiment's axes
  std::vector<ReportedRun> runs;    ///< those that are finished
};

struct ReportedTables {
  const ReportedExperiment* experiment = nullptr;
  std::vector<ReportedRow> rows;
};

/// Whether `folder` holds a campaign.
[[nodiscard]] bool is_campaign(const std::filesystem::path& folder);

/// Reads the folders of one campaign's shards. Throws StartupError where a folder holds no campaign, or a shard of
/// another one.
class CampaignReport {
 public:
  explicit CampaignReport(const std::vector<std::filesystem::path>& folders);

  /// Runs that no folder has a mark of.
  [[nodiscard]] std::size_t missing() const { return missing_; }
  /// The same for the same runs, however many folders they came from.
  [[nodiscard]] ReportPage page() const;

 private:
  void read_row(const std::vector<std::filesystem::path>& folders, const ReportedExperiment& experiment,
                ReportedTables& tables);

  ReportedCampaign campaign_;
  std::vector<ReportedTables> tables_;
  std::size_t runs_ = 0, missing_ = 0;
};

/// The tables of one experiment.
[[nodiscard]] std::vector<ReportTable> tables_of(const ReportedTables& experiment);
/// Time lost by map, s; none for one map or many.
[[nodiscard]] std::vector<MapPanel> map_panels(const ReportedTables& experiment);
/// Settings against the first that differs in one option or key alone, over runs of the same scenario and seed; no
/// table where there are none.
[[nodiscard]] std::vector<ReportTable> paired_tables(const ReportedTables& experiment);
/// A row a run.
[[nodiscard]] ReportTable runs_table(const std::vector<ReportedTables>& all);
[[nodiscard]] std::vector<ReportCard> cards_of(const std::vector<ReportedTables>& all);

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
