#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "planner/paper/map_field.h"

namespace jaywalk {

/// Walls grow by this on every map, in cells.
inline constexpr float kBenchInflation = 3.0F;

/// A map to measure on, with a goal and a start that are free after inflation.
struct BenchMap {
  std::string name;
  paper::CellMap cells;
  CellIndex goal, start;
};

/// Open room, office, serpentine corridors 1.5 m and 1.0 m wide, clutter: `side` cells of 0.1 m a side, walls all
/// round. The same bytes on every machine.
[[nodiscard]] std::vector<BenchMap> bench_maps(std::int32_t side);

/// A map of lines or discs from a file, its cells chosen so that it fills `side` of them; the goal near its middle, the
/// start near its upper right corner. Throws StartupError.
[[nodiscard]] BenchMap scaled_map(const std::filesystem::path& file, std::int32_t side);

}  // namespace jaywalk
