#include "apps/why/recorded_run.h"

#include <algorithm>
#include <utility>

#include "apps/rivals/paper_mode.h"
#include "firmware/recording/run_folders.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// Oldest first. Throws StartupError where the first is no file that can be read: a pipe would be waited for.
std::vector<std::filesystem::path> recordings_of(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> files;
  const bool is_folder = std::filesystem::is_directory(run);
  if (is_folder)
    for (const std::filesystem::path& part : parts_of(run)) files.push_back(part / "recording.jwr");
  if (files.empty()) files.push_back(is_folder ? run / "recording.jwr" : run);
  require_readable(files[0], files[0].string() + ": ", "give a recording.jwr that a run left in its --out");
  return files;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  std::error_code missing;
  return std::filesystem::canonical(file, missing).parent_path();
}

}  // namespace

RecordedRun::RecordedRun(const std::filesystem::path& run, FilePart place)
    : files_(recordings_of(run)), reader_(std::make_unique<RecordingReader>(files_[0].string(), place)) {
  file_ = is_in_parts() ? run : files_[0];
  setup_ = setup_from_text(reader_->setup(), files_[0].string());
  equip(setup_);
  if (setup_.backend == Backend::kCuda) setup_.backend = Backend::kAuto;  // the same bits wherever it is replayed
  if (!reader_->next(record_))
    throw StartupError(files_[0].string() + ": no whole tick in it", "take an undamaged copy of the recording");
  if (!begins_anew()) return;
  const Pose2& at = setup_.start = record_.pose.map_from_robot;
  setup_.judges_motion = false;  // the wheels obeyed commands that a new run did not give
  anew_ = formatted(
      "begins with part %d of its run, at %.2f s: lived through as a new run from %.2f, %.2f, heading %.2f, "
      "with nothing mapped, followed, planned or latched before",
      setup_.part, to_seconds(record_.now), at.x, at.y, at.heading);
}

std::filesystem::path RecordedRun::folder() const {
  const std::filesystem::path place = folder_of(files_[0]);
  return part_number(place) > 0 ? place.parent_path() : place;
}

bool RecordedRun::lies_in(const std::filesystem::path& folder) const {
  std::error_code missing;
  const auto is_it = [&](const std::filesystem::path& own) {
    return std::filesystem::equivalent(own, folder, missing);
  };
  return is_it(this->folder()) || std::ranges::any_of(files_, is_it, folder_of);
}

bool RecordedRun::step() {
  if (!std::exchange(begun_, true)) return true;  // the first, which is read already
  while (!reader_->next(record_))
    if (!reader_->warning().empty() || !open_next()) return false;
  return true;
}

bool RecordedRun::open_next() {
  const bool is_last = opened_ + 1 == files_.size();
  if (opened_ == files_.size() || (is_last && has_nothing(files_[opened_]))) return false;
  reader_ = std::make_unique<RecordingReader>(files_[opened_++].string());
  return true;
}

std::string RecordedRun::remarks(std::uint64_t different, const std::string& does) const {
  std::string text = anew_.empty() ? "" : "jaywalk: " + file_.string() + ": " + anew_ + "\n";
  if (!reader_->warning().empty()) text += "jaywalk: " + reader_->warning() + "\n";
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

RelivedRun::RelivedRun(RecordedRun& run)
    : run_(run),
      devices_(run.last()),
      planner_(make_planner(run.setup()).planner, run.last()),
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
