#pragma once
#include <filesystem>
#include <vector>

namespace jaywalk {

struct ReportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;  ///< of a campaign's report; empty: "report" in the first folder
};

/// Tells a single run in words, or writes the report of a campaign. Returns the process's exit code: 1 where runs of
/// the campaign are missing, else 0. Throws StartupError for bad input.
[[nodiscard]] int run_report(const ReportOptions& options);

}  // namespace jaywalk
