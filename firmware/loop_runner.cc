#include "firmware/loop_runner.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::string recording_in(const RunParts& parts) { return (parts.place() / "recording.jwr").string(); }

/// A known map is in the head of every part.
const PartsKept& checked(const PartsKept& kept, const ControlSetup& setup) {
  const std::uintmax_t head = kept.bytes > 0 ? to_text(setup).size() : 0, least = std::max(kLeastPartBytes, 4 * head);
  if (kept.bytes == 0 || kept.bytes >= least) return kept;
  throw StartupError("--part-bytes " + std::to_string(kept.bytes) + ": too small: the head of each part has " +
                         std::to_string(head) + " bytes",
                     "give " + std::to_string(least) + " at least, or 0 for no parts");
}

}  // namespace

LoopRunner::LoopRunner(const ControlSetup& setup, Hal hal, const Files& files, TickObserver& observer,
                       const MakePlanner& make)
    : setup_(setup),
      clock_(hal.clock),
      out_(files.folder),
      parts_(files.folder, checked(files.parts, setup)),
      chosen_(make ? make(setup) : make_planner(setup)),
      recorder_({.file = files.records ? recording_in(parts_) : "", .setup = to_text(setup)}),
      loop_(setup, hal, *chosen_.planner, recorder_),
      observer_(observer),
      recording_(files.records && !parts_.any() ? std::optional(files.folder / "recording.jwr") : std::nullopt),
      due_(hal.clock.now()) {
  observer_.begin(files.folder, parts_.place(), setup_);
}

const TickRecord& LoopRunner::step_at(Time due) {
  clock_.sleep_until(due);
  tick_at(due);
  drain();
  return *record_;
}

/// What is recorded stays within its bounds, whatever happens: without a next part it ends.
void LoopRunner::begin_part() noexcept try {
  parts_.next();
  ControlSetup setup = setup_;
  setup.part = parts_.number();
  recorder_.continue_in(recording_in(parts_), to_text(setup));
  observer_.continue_in(parts_.place(), recorder_.last_drained());
} catch (const StartupError& error) {
  recorder_.end_recording();
  observer_.end_tables();
  const std::string said = error.what();
  tell_loss(said.substr(0, said.rfind("; ")));  // the remedy is not the one for a start
}

void LoopRunner::drain() {
  if (losses_.empty() && parts_.is_full(recorder_.bytes() + observer_.bytes())) begin_part();
  if (!recorder_.drain()) tell_losses();
}

void LoopRunner::report(const RunSample& sample) {
  observer_.report(sample);
  if (observer_.is_losing()) tell_losses();
}

void LoopRunner::tell_losses() {
  std::vector<std::string> complaints = observer_.complaints();
  if (std::string complaint = recorder_.complaint(); !complaint.empty()) complaints.push_back(std::move(complaint));
  for (const std::string& complaint : complaints)
    if (std::find(losses_.begin(), losses_.end(), complaint) == losses_.end()) tell_loss(complaint);
}

void LoopRunner::tell_loss(const std::string& complaint) {
  losses_.push_back(complaint);
  recorder_.note_loss();
  std::fprintf(stderr, "jaywalk: %s; free some space; what stands in it is whole up to now\n", complaint.c_str());
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
  RunSample sample{.record = *record_,
                   .tracks = loop_.tracker().tracks(),
                   .truth = truth,
                   .tick_took = took_,
                   .loop = &loop_,
                   .planner = chosen_.planner.get()};
  if (loop_.plan().sequence != plan_reported_) sample.plan_took = loop_.plan().took;
  plan_reported_ = loop_.plan().sequence;
  if (own) sample.now = own(sample.now), sample.scanned = own(sample.scanned);
  report(sample);
}

std::filesystem::path LoopRunner::finish(RunEnd end) {
  recorder_.close();
  tell_losses();
  const std::vector<std::string> tables = observer_.complaints();
  for (const std::string& loss : losses_)
    if (std::find(tables.begin(), tables.end(), loss) == tables.end()) end.not_recorded.push_back(loss);
  end.dropped_records = recorder_.dropped();
  end.backend = chosen_.planner->backend();
  if (!chosen_.why_not_cuda.empty()) end.backend += " (" + chosen_.why_not_cuda + ")";
  end.mode = name_of(setup_.mode);
  end.version = JAYWALK_VERSION;
  if (recording_) end.recording = *recording_;
  if (end.title.empty()) end.title = end.scenario;
  const std::filesystem::path shown = observer_.finish(end, loop_, *chosen_.planner);
  tell_losses();
  return shown.empty() ? out_.path() : shown;
}

void LoopRunner::require_recorded() const {
  if (losses_.empty()) return;
  throw StartupError(losses_.front(), "free some space and run again; what stands in it is whole up to there");
}

}  // namespace jaywalk
