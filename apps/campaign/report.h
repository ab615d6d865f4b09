#pragma once
// The report of a campaign from the folders of its shards.
#include <filesystem>
#include <string>
#include <vector>

#include "apps/campaign/campaign_folder.h"
#include "apps/campaign/plan_text.h"
#include "apps/campaign/report_page.h"

namespace jaywalk::campaign {

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

}  // namespace jaywalk::campaign
