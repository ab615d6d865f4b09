#include "apps/report/run_observer.h"

#include "firmware/control_loop.h"

namespace jaywalk {

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
