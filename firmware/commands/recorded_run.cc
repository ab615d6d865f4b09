#include "firmware/commands/recorded_run.h"

#include "hal/types/errors.h"

namespace jaywalk {

RecordedRun::RecordedRun(const std::filesystem::path& run)
    : file_(std::filesystem::is_directory(run) ? run / "recording.jwr" : run),
      reader_(file_.string()),
      setup_(setup_from_text(reader_.setup(), file_.string())) {}

bool RecordedRun::step() {
  const bool any = reader_.next(record_);
  if (!any && !begun_)
    throw StartupError(file_.string() + ": no whole tick in it", "take an undamaged copy of the recording");
  begun_ = true;
  return any;
}

std::string RecordedRun::remarks(std::uint64_t different, const std::string& does) const {
  std::string text = reader_.warning().empty() ? "" : "jaywalk: " + reader_.warning() + "\n";
  if (different > 0) {
    text += "jaywalk: " + file_.string() + ": this program " + does + " otherwise in " + std::to_string(different) +
            " ticks; what is told is its own\n";
  }
  return text;
}

bool SeenRun::step() {
  if (!run_.step()) return false;
  (void)estimator_.update(last());
  estimator_.forget_where_stuck(last());
  estimator_.end_tick(last());
  if (estimator_.pose().map_from_robot != last().pose.map_from_robot) ++different_;
  return true;
}

}  // namespace jaywalk
