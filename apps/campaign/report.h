#pragma once
// The report of a campaign from the folders of its shards: figures and pictures first, then HTML and Markdown, which
// say the same.
#include <filesystem>
#include <string>
#include <utility>
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
  std::vector<ReportTable> tables;
  std::vector<ReportChart> charts;
};

struct ReportPage {
  std::string title;
  std::string text;
  std::vector<std::pair<std::string, std::string>> cards;  ///< figures to be read first, "94.0 %", and what they are
  std::vector<ReportSection> sections;
  std::vector<ReportFailure> failures;
  ReportTable runs;         ///< those that are finished; the first cell is the folder below the campaign's
  std::size_t missing = 0;  ///< runs that no folder has a mark of
};

/// One file that needs no other; its links to the runs' folders hold where it lies in a folder of the campaign's.
[[nodiscard]] std::string html_of(const ReportPage& page);
/// Refers to charts beside it (charts/NAME.svg) and to pictures (failures/NUMBER.svg, from 1).
[[nodiscard]] std::string markdown_of(const ReportPage& page);

/// A run of the plan and what came of it.
struct ReportedRun {
  const PlannedRun* run = nullptr;
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

[[nodiscard]] bool is_campaign(const std::filesystem::path& folder);

/// The report of one campaign from the folders of its shards: the same for the same runs, however many folders they
/// came from. Throws StartupError where a folder holds no campaign, or a shard of another one.
[[nodiscard]] ReportPage page_of(const std::vector<std::filesystem::path>& folders);

/// Calls `visit` with each finished run, in the plan's order.
template <class Visit>
void for_each_run(const std::vector<ReportedTables>& all, const Visit& visit) {
  for (const ReportedTables& tables : all) {
    for (const ReportedRow& row : tables.rows)
      for (const ReportedRun& run : row.runs) visit(run);
  }
}

/// A row for each of `rows`, begun with its name, and a column for each of `columns`.
template <class Rows, class Columns, class Head, class Cell>
ReportTable table_with(const std::string& title, const Rows& rows, const Columns& columns, const Head& head,
                       const Cell& cell) {
  ReportTable table{title, {""}, {}};
  for (const auto& column : columns) table.head.push_back(head(column));
  for (const auto& row : rows) {
    table.rows.push_back({row.name});
    for (const auto& column : columns) table.rows.back().push_back(cell(row, column));
  }
  return table;
}

/// Most columns of tables and panels by scenario: drawn worlds are more, and have none.
inline constexpr std::size_t kMostColumns = 12;

[[nodiscard]] std::vector<ReportTable> tables_of(const ReportedTables& experiment);
/// Settings against the first that differs in one option or key alone, over runs of the same scenario and seed.
[[nodiscard]] ReportTable paired_table(const ReportedTables& experiment);
/// Turns of a row's runs in each bin of PathShape's histogram.
[[nodiscard]] std::vector<double> turns_of(const ReportedRow& row);
[[nodiscard]] ReportTable runs_table(const std::vector<ReportedTables>& all);
[[nodiscard]] std::vector<std::pair<std::string, std::string>> cards_of(const std::vector<ReportedTables>& all);

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

/// A line for each experiment that varies movers.count, and within it for each setting of what else varies.
[[nodiscard]] std::vector<SuccessLine> success_lines(const std::vector<ReportedTables>& all);

/// A row for each line, a column for each number of movers, and the paper's row; "-" where nothing was run.
[[nodiscard]] ReportTable success_table(const std::vector<SuccessLine>& lines);

/// Success against movers, with the paper's own points (its table 1) beside the lines; movers on a scale of doublings.
[[nodiscard]] std::string success_chart(const std::vector<SuccessLine>& lines);

/// The paper's histograms of turning angles, one beside the other; heights are shares on a scale of tenfolds, so that
/// rare wide turns are seen.
[[nodiscard]] std::string turn_chart(const std::vector<ReportedRow>& rows);

/// Against the shortest path at the greatest speed, s; NaN of a run that did not arrive.
[[nodiscard]] double time_lost_s(const ReportedRun& run);

/// Time lost by map: a small panel a map, all with the same axes: a column a row of the experiment, a dot a run; an
/// open dot at the top did not arrive. Empty for one map or many.
[[nodiscard]] std::string map_chart(const ReportedTables& tables);

struct Interval {
  double low = 0.0, high = 1.0;
};

/// 95 % interval of a share of `runs` that succeeded (Wilson 1927, z = 1.96); of no runs: 0 to 1.
[[nodiscard]] Interval wilson(std::size_t successes, std::size_t runs);

/// The middle value, the mean of both where there are two; NaN of none. NaN among them are left out.
[[nodiscard]] double median(std::vector<double> values);
/// The smallest value that at least `share` of all do not exceed (nearest rank); NaN of none. NaN are left out.
[[nodiscard]] double quantile(std::vector<double> values, double share);
/// Half of the 95 % interval of the mean of two values or more (Student's t, by Cornish and Fisher's expansion).
[[nodiscard]] double half_interval(const std::vector<double>& values);
[[nodiscard]] double mean(const std::vector<double>& values);

/// With so many digits behind the point, whatever the locale; "-" for NaN.
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace jaywalk::campaign
