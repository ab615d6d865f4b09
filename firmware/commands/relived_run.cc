#include "firmware/commands/relived_run.h"

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::filesystem::path recording_of(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? run / "recording.jwr" : run;
}

ControlSetup setup_of(const RecordingReader& reader, const std::string& file) {
  ControlSetup setup = setup_from_text(reader.setup(), file);
  if (setup.backend == Backend::kCuda) setup.backend = Backend::kAuto;  // the bits are the same wherever it is replayed
  return setup;
}

}  // namespace

RelivedRun::RelivedRun(const std::filesystem::path& run)
    : file_(recording_of(run)),
      reader_(file_.string()),
      setup_(setup_of(reader_, file_.string())),
      planner_(make_planner(setup_.planner(), setup_.backend).planner, recorded_),
      loop_(setup_, devices_.hal(), planner_, recorder_) {}

bool RelivedRun::step() {
  if (!reader_.next(recorded_)) {
    if (last_ != nullptr) return false;
    throw StartupError(file_.string() + ": no whole tick in it", "take an undamaged copy of the recording");
  }
  last_ = &loop_.tick(recorded_.now);
  recorder_.drain();
  const WheelCommand& now = devices_.commanded();
  const bool same = now.left_radps == recorded_.command.left_radps && now.right_radps == recorded_.command.right_radps;
  different_ += same ? 0 : 1;
  return true;
}

std::string RelivedRun::remarks() const {
  std::string text = reader_.warning().empty() ? "" : "jaywalk: " + reader_.warning() + "\n";
  if (different_ > 0) {
    text += "jaywalk: " + file_.string() + ": this program commands otherwise in " + std::to_string(different_) +
            " ticks; what is told is its own\n";
  }
  return text;
}

}  // namespace jaywalk
