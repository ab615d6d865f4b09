#pragma once
#include <filesystem>
#include <functional>

#include "hil/faults/fault_bench.h"

namespace jaywalk::faults {

/// Runs every fault on every kind of drive at 0.3, 0.6 and 1.2 m/s, in a loop of `rate_hz`, and tells each row as it
/// comes. `folder` holds the files of the run under way. Returns how many rows are not ok. Throws StartupError.
[[nodiscard]] int run_matrix(double rate_hz, const std::filesystem::path& folder,
                             const std::function<void(const FaultResult&)>& tell);

}  // namespace jaywalk::faults
