#pragma once
// Mode paper, the potential of a map alone, and the rival planners: of the desktop program alone.
#include <filesystem>
#include <memory>
#include <optional>

#include "firmware/backends.h"
#include "hal/types/geometry.h"
#include "planner/paper/map_field.h"
#include "planner/paper/paper.h"

namespace jaywalk {

/// Gives a setup the motion and planner that its mode and rival name. Throws nothing.
void equip(ControlSetup& setup) noexcept;

/// The potential of a map alone, on the backend that make_planner() would take, without trial and fall-back. Throws
/// StartupError where kCuda cannot be had.
[[nodiscard]] std::unique_ptr<paper::MapField> make_map_field(const paper::CellMap& map, Backend backend,
                                                              int device = 0);
/// The paper's planner on the backend that make_planner() would take, without trial.
[[nodiscard]] ChosenPlanner make_paper_planner(const paper::PaperConfig& config, Backend backend, int device = 0);

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
