#pragma once
#include <filesystem>
#include <optional>

#include "hal/types/geometry.h"
#include "planner/paper/map_field.h"

namespace jaywalk {

/// A map file as square cells.
struct MapCells {
  paper::CellMap cells;
  Pose2 map_from_cells;  ///< of the lowest cell's low corner
  double cell_m = 0.0;
};

/// Reads any kind of map, told by its file's ending. `cell_m` is needed for a picture alone, chooses the cells of a map
/// of lines or discs (default 0.1 m), and is refused for a map_server file, which says it itself. Pictures of more than
/// 2,048 pixels a side are read in larger cells. Throws StartupError.
[[nodiscard]] MapCells load_map_cells(const std::filesystem::path& file, std::optional<double> cell_m);

}  // namespace jaywalk
