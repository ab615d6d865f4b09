#include "firmware/commands/loop_runner.h"

#include <chrono>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

ChosenPlanner wrapped(ChosenPlanner chosen, const LoopRunner::Wrap& wrap) {
  if (wrap) chosen.planner = wrap(std::move(chosen.planner));
  return chosen;
}

}  // namespace

LoopRunner::LoopRunner(const ControlSetup& setup, Hal hal, const std::filesystem::path& out, bool record,
                       const Wrap& wrap)
    : setup_(setup),
      clock_(hal.clock),
      out_(out),
      chosen_(wrapped(make_planner(setup.planner(), setup.backend), wrap)),
      recorder_({.file = record ? out_.file("recording.jwr").string() : "", .setup = to_text(setup)}),
      loop_(setup, hal, *chosen_.planner, recorder_),
      report_(out),
      due_(hal.clock.now()) {
  if (!chosen_.remark.empty()) std::fprintf(stderr, "jaywalk: %s\n", chosen_.remark.c_str());
}

const TickRecord& LoopRunner::step_at(Time due) {
  clock_.sleep_until(due);
  tick_at(due);
  recorder_.drain();
  return *record_;
}

const TickRecord& LoopRunner::tick_at(Time due) noexcept {
  const auto began = std::chrono::steady_clock::now();
  record_ = &loop_.tick(due);
  took_ = std::chrono::steady_clock::now() - began;
  if (took_ > setup_.tick()) ++overruns_;
  due_ = due + setup_.tick();
  return *record_;
}

void LoopRunner::report(const TrueState* truth, const OwnTime& own) {
  RunSample sample{.record = *record_, .tracks = loop_.tracker().tracks(), .truth = truth, .tick_took = took_};
  if (loop_.plan().sequence != plan_reported_) sample.plan_ms = loop_.plan().duration_ms;
  plan_reported_ = loop_.plan().sequence;
  if (own) sample.now = own(sample.now), sample.scanned = own(sample.scanned);
  report_.add(sample);
}

void LoopRunner::finish(RunEnd end) {
  const bool recorded = recorder_.close();
  end.dropped_records = recorder_.dropped();
  end.backend = chosen_.planner->backend();
  end.mode = name_of(setup_.mode);
  end.version = JAYWALK_VERSION;
  report_.finish(end);
  if (!recorded) {
    throw StartupError(out_.file("recording.jwr").string() + ": the disk did not take all of it",
                       "free some space and run again");
  }
}

}  // namespace jaywalk
