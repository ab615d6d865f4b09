#pragma once
// campaign.json: all that a report needs to know of a campaign beside its runs.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/campaign/campaign.h"

namespace jaywalk::campaign {

struct ReportedExperiment {
  std::string name, title;
  std::vector<std::string> axes;       ///< names
  std::vector<std::string> scenarios;  ///< without folder and end
  std::vector<PlannedRun> runs;        ///< with experiment, row, values, scenario, seed, folder and cruise_mps alone
  std::vector<std::string> commands;   ///< of the runs
};

struct ReportedCampaign {
  std::string title;
  std::string program;  ///< "jaywalk 0.1.0", and the digest of its file
  std::vector<ReportedExperiment> experiments;
};

/// Of the same campaign, scenarios and program always the same text. `program`: jaywalk's file.
[[nodiscard]] std::string plan_text(const Campaign& campaign, const Plan& plan, const std::filesystem::path& program);

/// Throws StartupError, naming `file`, for what is no such text.
[[nodiscard]] ReportedCampaign read_plan(const std::filesystem::path& file);

/// FNV-1a, 64 bits (Fowler, Noll and Vo; RFC 9923), as 16 hexadecimal digits: tells files apart, keeps no secret.
[[nodiscard]] std::string digest_of_text(std::string_view text);
/// Digest of a file's bytes; of an empty text where it cannot be read.
[[nodiscard]] std::string digest_of_file(const std::filesystem::path& file);

}  // namespace jaywalk::campaign
