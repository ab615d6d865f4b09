#include "apps/why/relived_run.h"

namespace jaywalk {
namespace {

std::unique_ptr<Planner> planner_for(ControlSetup setup) {
  // The bits are the same wherever it is replayed.
  if (setup.backend == Backend::kCuda) setup.backend = Backend::kAuto;
  return make_planner(setup).planner;
}

}  // namespace

RelivedRun::RelivedRun(RecordedRun& run)
    : run_(run),
      devices_(run.last()),
      planner_(planner_for(run.setup()), run.last()),
      loop_(run.setup(), devices_.hal(run.setup().model.lasers().size()), planner_, recorder_) {}

bool RelivedRun::step() {
  if (!run_.step()) return false;
  const TickRecord& recorded = run_.last();
  last_ = &loop_.tick(recorded.now);
  recorder_.drain();
  const WheelCommand& now = devices_.commanded();
  const bool same = now.left_radps == recorded.command.left_radps && now.right_radps == recorded.command.right_radps;
  different_ += same ? 0 : 1;
  return true;
}

}  // namespace jaywalk
