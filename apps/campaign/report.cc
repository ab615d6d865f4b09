#include "apps/campaign/report.h"

#include <algorithm>
#include <cmath>

#include "apps/campaign/charts.h"
#include "apps/campaign/statistics.h"
#include "hal/text_file.h"

namespace jaywalk::campaign {
namespace {

std::vector<TurnBars> turn_bars(const ReportedTables& tables) {
  std::vector<TurnBars> all;
  for (const ReportedRow& row : tables.rows) {
    TurnBars bars{row.name, {}};
    double sum = 0.0;
    for (const ReportedRun& run : row.runs)
      for (std::size_t k = 0; k < kTurnBins; ++k) bars.shares[k] += run.result.turns[k], sum += run.result.turns[k];
    for (double& share : bars.shares) share = sum > 0.0 ? share / sum : 0.0;
    all.push_back(bars);
  }
  return all;
}

ReportFailure failure_of(const ReportedRun& run) {
  const bool moment = std::isfinite(run.result.at_s);
  ReportFailure failure;
  failure.run = run.run->folder;
  failure.what =
      run.result.outcome + (moment ? " at " + fixed(run.result.at_s, 2) + " s" : "") + ": " + run.result.reason;
  failure.repeat = *run.command;
  if (moment) failure.why = "jaywalk why out/" + run.run->folder + " " + fixed(run.result.at_s, 2) + " --out out/why";
  failure.svg = text_in(run.folder / "run.svg");
  return failure;
}

ReportSection section_of(const ReportedTables& tables) {
  const ReportedExperiment& experiment = *tables.experiment;
  ReportSection section{experiment.title, "", tables_of(tables), {}};
  section.charts.push_back(
      {"turns_" + experiment.name,
       "Turning angles every 0.25 m, degrees; heights are shares from 0.01 % to 100 %, by tenfolds",
       turn_chart(turn_bars(tables))});
  if (const std::vector<MapPanel> panels = map_panels(tables); !panels.empty())
    section.charts.push_back(
        {"maps_" + experiment.name,
         "Seconds lost against the shortest way, by map: columns as the tables' rows, a dot a run, "
         "an open one did not arrive",
         map_chart(panels)});
  return section;
}

/// Of all runs' robot.csv in the plan's order: two programs that give the same drive alike.
std::string digest_of(const std::vector<ReportedTables>& all) {
  std::string digests;
  for (const ReportedTables& tables : all) {
    for (const ReportedRow& row : tables.rows)
      for (const ReportedRun& run : row.runs) digests += run.result.robot_csv + "\n";
  }
  return digest_of_text(digests);
}

ReportedRow& row_of(ReportedTables& tables, const PlannedRun& run) {
  if (tables.rows.empty() || tables.rows.back().values != run.values) tables.rows.push_back({run.row, run.values, {}});
  return tables.rows.back();
}

}  // namespace

bool is_campaign(const std::filesystem::path& folder) { return std::filesystem::exists(folder / "campaign.json"); }

CampaignReport::CampaignReport(const std::vector<std::filesystem::path>& folders) {
  for (const std::filesystem::path& folder : folders) {
    if (!is_campaign(folder))
      throw StartupError(folder.string() + ": holds no campaign", "give folders of one campaign, or a single run's");
    if (text_in(folder / "campaign.json") != text_in(folders.front() / "campaign.json"))
      throw StartupError(folder.string() + ": holds another campaign than " + folders.front().string(),
                         "give folders of the same campaign, scenarios and program");
  }
  campaign_ = read_plan(folders.front() / "campaign.json");
  for (const ReportedExperiment& experiment : campaign_.experiments) {
    tables_.push_back({&experiment, {}});
    read_row(folders, experiment, tables_.back());
  }
}

void CampaignReport::read_row(const std::vector<std::filesystem::path>& folders, const ReportedExperiment& experiment,
                              ReportedTables& tables) {
  for (std::size_t k = 0; k < experiment.runs.size(); ++k) {
    const PlannedRun& run = experiment.runs[k];
    ReportedRow& row = row_of(tables, run);
    const auto has_it = [&](const auto& folder) { return std::filesystem::exists(place_of(folder, run) / "run.json"); };
    const auto folder = std::find_if(folders.begin(), folders.end(), has_it);
    ++runs_;
    if (folder == folders.end()) {
      ++missing_;
      continue;
    }
    const std::filesystem::path place = place_of(*folder, run);
    row.runs.push_back({&run, &experiment.commands[k], read_result(place / "run.json"), place});
  }
}

ReportPage CampaignReport::page() const {
  ReportPage page;
  page.title = campaign_.title;
  page.text = std::to_string(runs_) + " runs by " + campaign_.program +
              "; all tables robot.csv together: " + digest_of(tables_) + ".";
  if (missing_ > 0) page.text += " " + std::to_string(missing_) + " runs are missing: they are in no table.";
  page.text +=
      " Success is the strict rule: the goal reached in time, nothing touched, no mover made to turn by the robot. "
      "Intervals are Wilson's, of 95 %.";
  page.cards = cards_of(tables_);
  page.runs = runs_table(tables_);
  const std::vector<SuccessLine> lines = success_lines(tables_);
  if (!lines.empty())
    page.sections.push_back({"Success against movers",
                             "",
                             {success_table(lines)},
                             {{"success", "Success against movers, with intervals of 95 %", success_chart(lines)}}});
  for (const ReportedTables& tables : tables_) page.sections.push_back(section_of(tables));
  for (const ReportedTables& tables : tables_) {
    for (const ReportedRow& row : tables.rows) {
      for (const ReportedRun& run : row.runs)
        if (!run.result.success) page.failures.push_back(failure_of(run));
    }
  }
  return page;
}

}  // namespace jaywalk::campaign
