#include "firmware/commands/run_picture.h"

#include <cstdio>

#include "firmware/report/picture/picture.h"
#include "firmware/report/picture/run_svg.h"

namespace jaywalk {
namespace {

constexpr double kSeenAround_m = 15.0;  // cells shown beyond the driven way

std::string text_of(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

void RunPicture::consider(const LoopRunner& runner) {
  const Plan& plan = runner.loop().plan();
  if (plan.sequence == plan_seen_) return;
  plan_seen_ = plan.sequence;
  const auto tracks = runner.loop().tracker().tracks();
  busiest_.consider(plan, runner.planner(), {tracks.begin(), tracks.end()}, runner.last().pose.map_from_robot);
}

std::filesystem::path RunPicture::save(const std::filesystem::path& folder, const std::string& title,
                                       const LoopRunner& runner, std::span<const WallLine> walls) const {
  const ControlSetup& setup = runner.setup();
  const EvidenceMap& map = runner.loop().tracker().still();
  PictureScene scene;
  scene.title = title;
  scene.facts = {{"path", text_of("%.1f m", runner.figures().path_length_m())},
                 {"duration", text_of("%.1f s", runner.figures().duration_s())},
                 {"mode", name_of(setup.mode)},
                 {"planner", runner.planner().backend()}};
  scene.walls.assign(walls.begin(), walls.end());
  scene.driven = runner.figures().driven();
  scene.occupied = occupied_cells(map, scene.driven, kSeenAround_m);
  scene.cell_m = map.cell_m();
  scene.zones = setup.zones;
  scene.movers = runner.figures().mover_trails();
  scene.tracks = runner.figures().track_trails();
  scene.moment = busiest_.moment();
  scene.start = setup.start;
  scene.goal = setup.goal;
  scene.goal_tolerance_m = setup.goal_tolerance_m;
  const OperatorInput& wanted = runner.last().input;
  if (wanted.wants_heading()) scene.goal_heading_rad = wanted.goal_heading_rad;
  scene.footprint = setup.model.footprint;
  scene.extent = extent_of(scene);
  draw_svg(scene, (folder / "run.svg").string());
  if (!can_draw_pictures()) return folder / "run.svg";
  draw_picture(scene, (folder / "run.png").string());
  return folder / "run.png";
}

}  // namespace jaywalk
