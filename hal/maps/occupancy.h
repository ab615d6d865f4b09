#pragma once
// Which cells of a picture are walls.
#include <filesystem>

#include "hal/maps/wall_map.h"

namespace jaywalk::sim {

/// map_server's modes (nav2_map_server's map_io): what a pixel's brightness says.
enum class MapMode : std::uint8_t {
  kTrinary,  ///< wall, free or unknown; transparency counts as a channel
  kScale,    ///< the same, shades between are unknown here; what is transparent is unknown
  kRaw       ///< brightness 0 to 100 of 255 is the occupancy in per cent, more is unknown; `negate` is no matter
};

struct OccupancyRule {
  MapMode mode = MapMode::kTrinary;
  bool negate = false;
  double occupied_above = 0.65, free_below = 0.196;
};

/// The picture's cells of `cell_m`, their frame at its lower left corner. Where it has more than `most_cells` a side,
/// squares of k x k of its pixels become a cell: a wall where one of them is, free where all of them are.
[[nodiscard]] Raster read_raster(const std::filesystem::path& image, const OccupancyRule& rule, double cell_m,
                                 std::int32_t most_cells);

}  // namespace jaywalk::sim
