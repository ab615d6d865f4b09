#pragma once
#include <filesystem>

namespace jaywalk {

struct ExportOptions {
  std::filesystem::path run;  ///< a run's folder, or a recording.jwr
  std::filesystem::path out;  ///< empty: run.mcap in the run's folder
};

/// A run's recording as MCAP, profile ros2, and a metadata.yaml beside it. The controller lives through the recording
/// again, since tracks, plans and map are not in it. Returns 0. Throws StartupError for bad input.
[[nodiscard]] int run_export(const ExportOptions& options);

}  // namespace jaywalk
