#pragma once
// A campaign's folder: what is to be run, and a folder for each run that is finished.
// campaign.json: all that a report needs to know of a campaign beside its runs.
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "apps/campaign/campaign.h"
#include "apps/report/drive_metrics.h"
#include "drivers/wire/file_descriptor.h"

namespace jaywalk::campaign {

struct ReportedExperiment {
  std::string name, title;
  std::vector<std::string> axes;       ///< names
  std::vector<std::string> scenarios;  ///< without folder and end
  std::vector<PlannedRun> runs;        ///< without arguments and goal
};

struct ReportedCampaign {
  std::string title;
  std::string program;  ///< "jaywalk 0.1.0", and the digest of its file
  std::vector<ReportedExperiment> experiments;
};

/// Text of campaign.json. The same campaign, scenarios and program give the same text. `program`: jaywalk's file.
[[nodiscard]] std::string plan_text(const Campaign& campaign, const Plan& plan, const std::filesystem::path& program);

/// Throws StartupError, naming `file`, for what is no such text.
[[nodiscard]] ReportedCampaign read_plan(const std::filesystem::path& file);

/// FNV-1a, 64 bits (Fowler, Noll and Vo; RFC 9923), as 16 hexadecimal digits: tells files apart, keeps no secret.
[[nodiscard]] std::string digest_of_text(std::string_view text);
/// Digest of a file's bytes; of an empty text where it cannot be read.
[[nodiscard]] std::string digest_of_file(const std::filesystem::path& file);

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  ///< a figure of which nothing is known

/// Result of one run, as its run.json has it. Where that is, the run is over.
struct RunResult {
  std::string outcome;     ///< summary.json's; "crashed" or "refused" where the program did not get so far
  bool success = false;    ///< by the strict rule
  std::string reason;      ///< of a failure, in words
  double at_s = kUnknown;  ///< its decisive moment on the run's clock; NaN where there is none
  std::string robot_csv;   ///< digest of the table
  std::map<std::string, double> figures;  ///< those of summary.json and ride_of() that are numbers, by name
  std::array<std::uint32_t, kTurnBins> turns{};

  /// The robot reached the goal; it may have forced a mover on the way.
  [[nodiscard]] bool arrived() const { return outcome == "reached" || outcome == "forced_mover"; }
  /// Whether there was a run at all.
  [[nodiscard]] bool ran() const { return outcome != "crashed" && outcome != "refused"; }
  /// NaN where the run does not have it.
  [[nodiscard]] double figure(const std::string& name) const {
    const auto found = figures.find(name);
    return found == figures.end() ? kUnknown : found->second;
  }
};

/// Result of a process that ended with `status` (waitpid's), by its tables and its output (said.txt) in `folder`.
/// Throws StartupError where a table that must be there is not ours.
[[nodiscard]] RunResult result_of(const PlannedRun& run, const std::filesystem::path& folder, int status);

/// run.json; figures come out as they went in.
[[nodiscard]] std::string to_text(const RunResult& result);
/// Throws StartupError, naming `file`, for what is no run.json.
[[nodiscard]] RunResult read_result(const std::filesystem::path& file);

/// A share of a campaign's runs: each `of`-th, beginning with the `part`-th; both count from 1.
struct Shard {
  std::size_t part = 1, of = 1;

  [[nodiscard]] bool has(std::size_t run) const { return run % of == part - 1; }
};

/// Where a finished run lies below a campaign's folder.
[[nodiscard]] inline std::filesystem::path place_of(const std::filesystem::path& campaign, const PlannedRun& run) {
  return campaign / "runs" / run.folder;
}

/// Holds the folder's share for as long as it lives. A run is worked on in a folder of the share's own and moved to its
/// place when its mark, run.json, lies in it: what has a mark is whole, whenever the process was killed.
class CampaignFolder {
 public:
  /// Makes it where it is missing. `text`: campaign.json's. Throws StartupError where it cannot be written to, holds
  /// another campaign, or another process runs this share.
  CampaignFolder(const std::filesystem::path& path, const std::string& text, const Shard& shard);

  [[nodiscard]] bool is_finished(const PlannedRun& run) const {
    return std::filesystem::exists(place_of(path_, run) / "run.json");
  }
  /// Of a finished one. Throws StartupError where its mark was spoiled.
  [[nodiscard]] RunResult result(const PlannedRun& run) const { return read_result(place_of(path_, run) / "run.json"); }
  /// Where it is worked on until it is finished.
  [[nodiscard]] std::filesystem::path work(const PlannedRun& run) const {
    return place_of(path_, run).string() + ".part-" + share_;
  }
  /// Makes that folder, empty.
  [[nodiscard]] std::filesystem::path begin(const PlannedRun& run) const;
  /// Leaves the mark, removes what is not to be kept, and moves the run to its place.
  void finish(const PlannedRun& run, const RunResult& result, Keep keep) const;
  /// Removes what was begun.
  void drop(const PlannedRun& run) const;

 private:
  std::filesystem::path path_;
  std::string share_;
  wire::FileDescriptor held_;
};

/// Writes a file that is whole or not there, whenever the process is killed. Throws StartupError where it cannot.
void write_whole(const std::filesystem::path& file, const std::string& text, const std::string& own_name = "begun");

/// Ride comfort of a run, from robot.csv, as RunResult::figures has it. steering_reversals, speed_reversals: how often
/// the robot turned or drove one way, and then the other; stood_share: of its ticks, slower than 0.05 m/s; hard_brakes:
/// how often it slowed down by more than 0.7 m/s2; calm_jerk_p99_mps3: 99th percentile of the jerk without them, NaN
/// where nothing is left. Throws StartupError where there is no such table.
[[nodiscard]] std::map<std::string, double> ride_of(const std::filesystem::path& robot_csv);

/// When (s) and why the run in `folder` came to `outcome`, which is no success, from its tables: the decisive moment,
/// and "mover 7 had to turn: ...". Throws StartupError where they are not there.
[[nodiscard]] std::pair<double, std::string> failure_words(const PlannedRun& run, const std::string& outcome,
                                                           const std::filesystem::path& folder);

}  // namespace jaywalk::campaign
