#pragma once
#include <filesystem>
#include <vector>

#include "bench/tracking/relative_pose.h"
#include "bench/tracking/run_folder.h"

namespace jaywalk::bench {

/// A recording's poses as others corrected them, against the run's and against the wheels' alone.
struct ReferencePoses {
  std::vector<PosePair> of_run, of_wheels;
};

/// From the FLASER lines of a corrected CARMEN log that the run replayed, or from a table `t,x,y,h` (.csv, .csv.gz; s,
/// m, rad), which knows no wheels. Throws StartupError when there are none.
[[nodiscard]] ReferencePoses reference_poses(const std::filesystem::path& log, const RunFolder& run);

}  // namespace jaywalk::bench
