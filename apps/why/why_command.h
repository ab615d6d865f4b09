#pragma once
#include <filesystem>

namespace jaywalk {

struct WhyOptions {
  std::filesystem::path run;  ///< a run's folder, or a recording.jwr
  double at_s = 0.0;
  std::filesystem::path out = "out/why";
};

/// One moment of a recording: a few sentences on standard output, and why.png. Returns 0. Throws StartupError for bad
/// input, a time outside the recording among it.
[[nodiscard]] int run_why(const WhyOptions& options);

}  // namespace jaywalk
