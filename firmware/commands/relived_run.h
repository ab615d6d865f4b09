#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/held_planner.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recorder.h"
#include "firmware/recording/recording_stream.h"

namespace jaywalk {

/// A recording that the controller lives through again, a tick at a time: tracks, plans and map are not in it.
class RelivedRun {
 public:
  /// A run's folder or its recording.jwr. Throws StartupError for what is no recording.
  explicit RelivedRun(const std::filesystem::path& run);

  /// Lives through the next tick; false at the recording's end. Throws StartupError for a damaged entry.
  [[nodiscard]] bool step();
  /// The tick just lived through.
  [[nodiscard]] const TickRecord& last() const { return *last_; }
  [[nodiscard]] const ControlLoop& loop() const { return loop_; }
  [[nodiscard]] const Planner& planner() const { return planner_; }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] double share_read() const { return reader_.share_read(); }
  /// What a person should know of it, a line each: commands that come out otherwise now, and where it was cut.
  [[nodiscard]] std::string remarks() const;

 private:
  std::filesystem::path file_;
  RecordingReader reader_;
  ControlSetup setup_;
  TickRecord recorded_;
  RecordedHal devices_{recorded_};
  HeldPlanner planner_;
  Recorder recorder_{{}};
  ControlLoop loop_;
  const TickRecord* last_ = nullptr;
  std::uint64_t different_ = 0;
};

}  // namespace jaywalk
