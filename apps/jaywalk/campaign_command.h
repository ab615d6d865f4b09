#pragma once
#include <filesystem>
#include <string>

#include "apps/campaign/campaign_folder.h"

namespace jaywalk {

struct CampaignOptions {
  std::filesystem::path file;
  std::filesystem::path out = "out/campaign";
  int jobs = 0;  ///< runs at a time; 0: as many as this process may use processors
  campaign::Shard shard;
};

/// "2/4": the second of four. Throws StartupError for what is none.
[[nodiscard]] campaign::Shard shard_from(const std::string& word);

/// Runs what of the campaign's share is not finished. Returns the process's exit code: 0 when all of it is finished,
/// whatever came of the runs; 1 when it was stopped, or runs of it crashed or were refused. Throws StartupError for bad
/// input.
[[nodiscard]] int run_campaign(const CampaignOptions& options);

}  // namespace jaywalk
