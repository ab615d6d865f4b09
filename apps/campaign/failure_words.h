#pragma once
#include <filesystem>
#include <string>

#include "apps/campaign/campaign.h"

namespace jaywalk::campaign {

struct FailureWords {
  double at_s = 0.0;   ///< the decisive moment
  std::string reason;  ///< "mover 7 had to turn: ..."
};

/// Why the run in `folder` came to `outcome`, which is no success, from its tables. Throws StartupError where they are
/// not there.
[[nodiscard]] FailureWords failure_words(const PlannedRun& run, const std::string& outcome,
                                         const std::filesystem::path& folder);

}  // namespace jaywalk::campaign
