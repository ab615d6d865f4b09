#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "firmware/control_setup.h"
#include "firmware/estimator.h"
#include "firmware/recording/recording_stream.h"

namespace jaywalk {

/// A run's recording, a tick at a time.
class RecordedRun {
 public:
  /// A run's folder or its recording.jwr. Throws StartupError for what is no recording.
  explicit RecordedRun(const std::filesystem::path& run);

  /// Reads the next tick; false at the recording's end. Throws StartupError for a damaged entry, and where there is no
  /// whole tick at all.
  [[nodiscard]] bool step();
  /// The tick just read, as it was recorded.
  [[nodiscard]] const TickRecord& last() const { return record_; }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] double share_read() const { return reader_.share_read(); }
  /// RecordingReader's.
  [[nodiscard]] bool holds_paths() const { return reader_.holds_paths(); }
  /// What a person should know of it, a line each: where it was cut, and in how many ticks this program `does`
  /// ("commands") otherwise than the one that recorded.
  [[nodiscard]] std::string remarks(std::uint64_t different, const std::string& does) const;

 private:
  std::filesystem::path file_;
  RecordingReader reader_;
  ControlSetup setup_;
  TickRecord record_;
  bool begun_ = false;
};

/// A recording seen again: localizer and tracker live through it, nothing is planned. What stood and moved is not in
/// it.
class SeenRun {
 public:
  /// `run`, at its beginning, outlives it.
  explicit SeenRun(RecordedRun& run) : run_(run), estimator_(run.setup()) {}

  /// RecordedRun's.
  [[nodiscard]] bool step();
  [[nodiscard]] const TickRecord& last() const { return run_.last(); }
  /// What was seen up to that tick.
  [[nodiscard]] const Tracker& tracker() const { return estimator_.tracker(); }
  /// RecordedRun's.
  [[nodiscard]] std::string remarks() const { return run_.remarks(different_, "sees"); }

 private:
  RecordedRun& run_;
  Estimator estimator_;
  std::uint64_t different_ = 0;  ///< ticks in which the robot is taken to be elsewhere
};

}  // namespace jaywalk
