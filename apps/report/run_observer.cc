#include "apps/report/run_observer.h"

#include "hal/shown_text.h"

namespace jaywalk {
constexpr double kSeenAround_m = 15.0;  // cells shown beyond the driven way

void RunObserver::consider(const ControlLoop& loop, const Planner& planner) {
  const Plan& plan = loop.plan();
  if (plan.sequence == plan_seen_) return;
  plan_seen_ = plan.sequence;
  const auto tracks = loop.tracker().tracks();
  busiest_.consider(plan, planner, {tracks.begin(), tracks.end()}, map_from_robot_);
}

PictureScene RunObserver::scene(const ControlLoop& loop, const Planner& planner) const {
  const EvidenceMap& map = loop.tracker().still();
  PictureScene scene;
  scene.facts = {{"path", formatted("%.1f m", report_->path_length_m())},
                 {"duration", formatted("%.1f s", report_->duration_s())},
                 {"mode", name_of(setup_.mode)},
                 {"planner", planner.backend()}};
  scene.walls = walls_;
  scene.driven = report_->driven();
  scene.occupied = occupied_cells(map, scene.driven, kSeenAround_m);
  scene.cell_m = map.cell_m();
  scene.zones = setup_.zones;
  scene.movers = report_->mover_trails();
  scene.tracks = report_->track_trails();
  scene.moment = busiest_.moment();
  scene.start = setup_.start;
  scene.goal = setup_.goal;
  scene.goal_tolerance_m = setup_.goal_tolerance_m;
  if (wanted_.wants_heading()) scene.goal_heading_rad = wanted_.goal_heading_rad;
  scene.footprint = setup_.model.footprint;
  scene.robot_from_laser = setup_.model.laser.robot_from_laser;
  scene.extent = extent_of(scene);
  return scene;
}

void RunObserver::report(const RunSample& sample) {
  report_->add(sample);
  wanted_ = sample.record.input;
  map_from_robot_ = sample.record.pose.map_from_robot;
  if (sample.loop == nullptr) return;
  consider(*sample.loop, *sample.planner);
  if (exporter_) exporter_->add(sample.record, sample.loop->tracker());
}

std::filesystem::path RunObserver::finish(const RunEnd& end, const ControlLoop& loop, const Planner& planner) {
  report_->finish(end);
  if (exporter_) exporter_->finish(end.recording);
  consider(loop, planner);
  PictureScene shown = scene(loop, planner);
  shown.title = end.title;
  draw_svg(shown, (out_ / "run.svg").string());
  if (!can_draw_pictures()) return out_ / "run.svg";
  draw_picture(shown, (out_ / "run.png").string());
  return out_ / "run.png";
}

}  // namespace jaywalk
