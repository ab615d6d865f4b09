#pragma once
#include <filesystem>
#include <optional>

namespace jaywalk {

struct BenchOptions {
  std::optional<std::filesystem::path> json;  ///< file for the rows; the table on the terminal comes always
  int largest = 2048;                         ///< cells a side
  std::optional<std::filesystem::path> map;   ///< one more map, of lines or discs, scaled to each size
};

/// Measures solver and planner, and what a user would pick instead, on the same maps in one run. Returns 0. Throws
/// StartupError when the file cannot be written or the map not read.
[[nodiscard]] int run_bench(const BenchOptions& options);

}  // namespace jaywalk
