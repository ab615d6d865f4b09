#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "firmware/control_loop.h"
#include "firmware/control_setup.h"
#include "firmware/estimator.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recorder.h"

namespace jaywalk {

/// A run's recording, a tick at a time; of one in parts, all that are left.
///
/// A part holds what crossed the HAL, and not what the controller had made of the parts before: map, tracks, plan,
/// faults that wait. Where the first part is gone the recording is that of a new run, which starts at the oldest tick's
/// pose.
class RecordedRun {
 public:
  /// A run's folder, a part's, or a recording.jwr; `place`: where in that file the recording stands. Throws
  /// StartupError for what is no recording, and where there is no whole tick at all.
  explicit RecordedRun(const std::filesystem::path& run, FilePart place = {});

  /// Reads the next tick; false at the recording's end. Throws StartupError for a damaged entry.
  [[nodiscard]] bool step();
  /// The tick just read, as it was recorded.
  [[nodiscard]] const TickRecord& last() const { return record_; }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  /// recording.jwr, or the folder of a run in parts.
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// The run's own, in which all but recording and tables lie.
  [[nodiscard]] std::filesystem::path folder() const;
  /// Whether `folder` is the run's own, or one of its parts'.
  [[nodiscard]] bool lies_in(const std::filesystem::path& folder) const;
  [[nodiscard]] bool is_in_parts() const { return files_.size() > 1; }
  /// It is lived through as a new run.
  [[nodiscard]] bool begins_anew() const { return setup_.part > 1; }
  [[nodiscard]] double share_read() const {
    return (static_cast<double>(opened_ - 1) + reader_->share_read()) / static_cast<double>(files_.size());
  }
  /// RecordingReader's.
  [[nodiscard]] std::uint64_t lost_before() const { return reader_->lost_before(); }
  /// What a person should know of it, a line each: that it begins anew, where it was cut, and in how many ticks this
  /// program `does` ("commands") otherwise than the one that recorded.
  [[nodiscard]] std::string remarks(std::uint64_t different, const std::string& does) const;

 private:
  [[nodiscard]] bool open_next();

  std::filesystem::path file_;
  std::vector<std::filesystem::path> files_;
  std::size_t opened_ = 1;  ///< of these
  std::unique_ptr<RecordingReader> reader_;
  ControlSetup setup_;
  TickRecord record_;
  bool begun_ = false;
  std::string anew_;  ///< in words, where it begins anew
};

/// A recording seen again: localizer and tracker live through it, nothing is planned. What stood and moved is not in
/// it.
class SeenRun {
 public:
  /// `run`, at its beginning, outlives it.
  explicit SeenRun(RecordedRun& run) : run_(run), estimator_(run.setup()) {}

  [[nodiscard]] bool step();
  [[nodiscard]] const TickRecord& last() const { return run_.last(); }
  /// What was seen up to that tick.
  [[nodiscard]] const Tracker& tracker() const { return estimator_.tracker(); }
  [[nodiscard]] std::string remarks() const { return run_.remarks(different_, "sees"); }

 private:
  RecordedRun& run_;
  Estimator estimator_;
  std::uint64_t different_ = 0;  ///< ticks in which the robot is taken to be elsewhere
};

/// A recording that the controller lives through again: how it decided is not in it.
class RelivedRun {
 public:
  /// `run`, at its beginning, outlives it.
  explicit RelivedRun(RecordedRun& run);

  [[nodiscard]] bool step();
  /// The tick just lived through.
  [[nodiscard]] const TickRecord& last() const { return *last_; }
  [[nodiscard]] const ControlLoop& loop() const { return loop_; }
  [[nodiscard]] const Planner& planner() const { return planner_; }
  [[nodiscard]] const RecordedRun& recorded() const { return run_; }
  [[nodiscard]] std::string remarks() const { return run_.remarks(different_, "commands"); }

 private:
  RecordedRun& run_;
  RecordedHal devices_;
  HeldPlanner planner_;
  Recorder recorder_{{}};
  ControlLoop loop_;
  const TickRecord* last_ = nullptr;
  std::uint64_t different_ = 0;
};

}  // namespace jaywalk
