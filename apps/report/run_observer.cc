#include "apps/report/run_observer.h"

#include "apps/report/picture/scene.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {
constexpr double kSeenAround_m = 15.0;  // cells shown beyond the driven way

}  // namespace

void RunPicture::consider(const ControlLoop& loop, const Planner& planner, const Pose2& map_from_robot) {
  const Plan& plan = loop.plan();
  if (plan.sequence == plan_seen_) return;
  plan_seen_ = plan.sequence;
  const auto tracks = loop.tracker().tracks();
  busiest_.consider(plan, planner, {tracks.begin(), tracks.end()}, map_from_robot);
}

std::filesystem::path RunPicture::save(const std::filesystem::path& folder, const std::string& title,
                                       const ShownRun& run) const {
  const ControlSetup& setup = run.setup;
  PictureScene scene;
  scene.title = title;
  scene.facts = {{"path", formatted("%.1f m", run.figures.path_length_m())},
                 {"duration", formatted("%.1f s", run.figures.duration_s())},
                 {"mode", name_of(setup.mode)},
                 {"planner", run.planner}};
  scene.walls.assign(run.walls.begin(), run.walls.end());
  scene.driven = run.figures.driven();
  scene.occupied = occupied_cells(run.map, scene.driven, kSeenAround_m);
  scene.cell_m = run.map.cell_m();
  scene.zones = setup.zones;
  scene.movers = run.figures.mover_trails();
  scene.tracks = run.figures.track_trails();
  scene.moment = busiest_.moment();
  scene.start = setup.start;
  scene.goal = setup.goal;
  scene.goal_tolerance_m = setup.goal_tolerance_m;
  if (run.wanted.wants_heading()) scene.goal_heading_rad = run.wanted.goal_heading_rad;
  scene.footprint = setup.model.footprint;
  scene.robot_from_laser = setup.model.laser.robot_from_laser;
  scene.extent = extent_of(scene);
  draw_svg(scene, (folder / "run.svg").string());
  if (!can_draw_pictures()) return folder / "run.svg";
  draw_picture(scene, (folder / "run.png").string());
  return folder / "run.png";
}

void RunObserver::begin(const std::filesystem::path& out, const std::filesystem::path& tables,
                        const ControlSetup& setup) {
  out_ = out;
  setup_ = setup;
  report_.emplace(out, tables);
  if (wants_mcap_) exporter_.emplace(out / "run.mcap", setup);
}

void RunObserver::report(const RunSample& sample) {
  report_->add(sample);
  wanted_ = sample.record.input;
  map_from_robot_ = sample.record.pose.map_from_robot;
  if (sample.loop == nullptr) return;
  picture_.consider(*sample.loop, *sample.planner, map_from_robot_);
  if (exporter_) exporter_->add(sample.record, sample.loop->tracker());
}

std::filesystem::path RunObserver::finish(const RunEnd& end, const ControlLoop& loop, const Planner& planner) {
  report_->finish(end);
  if (exporter_) exporter_->finish(end.recording);
  picture_.consider(loop, planner, map_from_robot_);
  return picture_.save(out_, end.title, {setup_, *report_, loop.tracker().still(), planner.backend(), wanted_, walls_});
}

}  // namespace jaywalk
