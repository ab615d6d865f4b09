#pragma once
#include <filesystem>
#include <optional>

namespace jaywalk {

struct BenchOptions {
  std::optional<std::filesystem::path> json;  ///< file for the rows; the table on the terminal comes always
  int largest = 2048;                         ///< cells a side
};

/// Measures solver and planner, and what a user would pick instead, on the same maps in one run. Returns 0. Throws
/// StartupError when the file cannot be written.
[[nodiscard]] int run_bench(const BenchOptions& options);

}  // namespace jaywalk
