#pragma once
// What came of one run: its mark, run.json.
#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "apps/campaign/campaign.h"
#include "apps/report/drive_metrics.h"

namespace jaywalk::campaign {

struct RunResult {
  std::string outcome;    ///< summary.json's; "crashed" or "refused" where the program did not get so far
  bool success = false;   ///< by the strict rule
  std::string reason;     ///< of a failure, in words
  double at_s = 0.0;      ///< its decisive moment on the run's clock; NaN where there is none
  std::string robot_csv;  ///< digest of the table
  std::map<std::string, double> figures;  ///< those of summary.json and of Ride that are numbers, by name
  std::array<std::uint32_t, kTurnBins> turns{};

  /// The robot reached the goal; it may have forced a mover on the way.
  [[nodiscard]] bool arrived() const { return outcome == "reached" || outcome == "forced_mover"; }
  /// Whether there was a run at all.
  [[nodiscard]] bool ran() const { return outcome != "crashed" && outcome != "refused"; }
  /// NaN where the run does not have it.
  [[nodiscard]] double figure(const std::string& name) const;
};

/// What the process that ended with `status` (waitpid's) left in `folder`: its tables, and what it said in said.txt.
/// Throws StartupError where a table that must be there is not ours.
[[nodiscard]] RunResult result_of(const PlannedRun& run, const std::filesystem::path& folder, int status);

/// run.json; figures come out as they went in.
[[nodiscard]] std::string to_text(const RunResult& result);
/// Throws StartupError, naming `file`, for what is no run.json.
[[nodiscard]] RunResult read_result(const std::filesystem::path& file);

}  // namespace jaywalk::campaign
