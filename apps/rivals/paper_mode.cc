#include "apps/rivals/paper_mode.h"

#include <cmath>
#include <string>
#include <utility>

#include "apps/rivals/baseline.h"
#include "hal/maps/image_file.h"
#include "hal/sim/walls.h"
#include "hal/text_file.h"

#if defined(JAYWALK_HAS_CUDA) && JAYWALK_HAS_CUDA
#include "cuda/paper/cuda_paper.h"
#include "hal/types/errors.h"
#else
namespace jaywalk::paper {
namespace {
std::unique_ptr<Planner> make_cuda_paper_planner(const PaperConfig&, int, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
std::unique_ptr<MapField> make_cuda_map_field(const CellMap&, int, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
}  // namespace
}  // namespace jaywalk::paper
#endif

namespace jaywalk {
namespace {

constexpr double kDefaultCell_m = 0.1;

MapCells cells_of(sim::Raster raster) {
  return {{raster.width, raster.height, std::move(raster.solid)}, raster.map_from_raster, raster.cell_m};
}

/// Rasters a map's lines and discs: a cell is occupied when its middle is within half a cell of one. So a line leaves
/// no gap for a step to a neighbour on a cell's side.
MapCells drawn_cells(const std::filesystem::path& file, sim::WallMap map, double cell_m) {
  const sim::Walls walls(std::move(map));
  const Box2 box = walls.bounds();
  const double width = std::floor((box.high.x - box.low.x) / cell_m) + 2.0;
  const double height = std::floor((box.high.y - box.low.y) / cell_m) + 2.0;
  if (!(width <= paper::kMostMapCells && height <= paper::kMostMapCells))
    throw StartupError(file.string() + ": more than 2048 cells a side", "choose larger cells: --resolution");
  MapCells drawn{{static_cast<std::int32_t>(width), static_cast<std::int32_t>(height), {}},
                 {box.low.x - cell_m / 2.0, box.low.y - cell_m / 2.0, 0.0},
                 cell_m};
  for (std::int32_t j = 0; j < drawn.cells.height; ++j) {
    for (std::int32_t i = 0; i < drawn.cells.width; ++i) {
      const Vec2 middle{box.low.x + i * cell_m, box.low.y + j * cell_m};
      drawn.cells.wall.push_back(walls.distance(middle, cell_m) <= cell_m / 2.0 ? 1 : 0);
    }
  }
  return drawn;
}

}  // namespace

void equip(ControlSetup& setup) noexcept {
  setup.make_motion = baseline::maker_of(setup.rival);
  if (setup.mode != PlanMode::kPaper) return;
  setup.make_motion = paper::make_motion;
  setup.make_planner = [](const ControlSetup& of) {
    return make_paper_planner({of.planner(), of.mover_radius_m()}, of.backend, of.device);
  };
}

ChosenPlanner make_paper_planner(const paper::PaperConfig& config, Backend backend, int device) {
  auto cpu = paper::make_cpu_paper_planner(config);
  if (backend == Backend::kCpu) return {std::move(cpu), ""};
  std::string why_not;
  auto planner = paper::make_cuda_paper_planner(config, device, why_not);
  return backed(backend, std::move(planner), std::move(cpu), why_not);
}

std::unique_ptr<paper::MapField> make_map_field(const paper::CellMap& map, Backend backend, int device) {
  if (backend == Backend::kCpu) return paper::make_cpu_map_field(map);
  std::string why_not;
  if (auto solver = paper::make_cuda_map_field(map, device, why_not)) return solver;
  if (backend == Backend::kCuda) refuse_cuda(why_not);
  return paper::make_cpu_map_field(map);
}

MapCells load_map_cells(const std::filesystem::path& file, std::optional<double> cell_m) {
  const std::string name = file.string(), ending = file.extension().string();
  if (cell_m && !(*cell_m >= 0.001 && *cell_m <= 10.0))
    throw StartupError("--resolution: outside 0.001 to 10 m", "give metres a cell");
  require_readable(file, name + ": ", "give a map's path");
  if (ending == ".yaml" || ending == ".yml") {
    if (cell_m) throw StartupError(name + ": says its resolution itself", "leave --resolution out");
    return cells_of(sim::load_raster(file, paper::kMostMapCells));
  }
  if (ending == ".png" || ending == ".pgm") {
    if (!cell_m) throw StartupError(name + ": a picture has no scale", "give --resolution, metres a pixel");
    return cells_of(sim::read_raster(file, {}, *cell_m, paper::kMostMapCells));
  }
  if (ending == ".map") return drawn_cells(file, sim::load_aria_map(file), cell_m.value_or(kDefaultCell_m));
  if (ending == ".txt") return drawn_cells(file, sim::load_cylinder_map(file), cell_m.value_or(kDefaultCell_m));
  throw StartupError(name + ": not a kind of map",
                     "give .yaml (map_server), .map (ARIA), .txt (cylinders), .png, .pgm");
}

}  // namespace jaywalk
