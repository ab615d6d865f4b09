#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/why/recorded_run.h"
#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recorder.h"

namespace jaywalk {

/// A recording that the controller lives through again: how it decided is not in it.
class RelivedRun {
 public:
  /// `run`, at its beginning, outlives it.
  explicit RelivedRun(RecordedRun& run);

  /// Lives through the next tick. RecordedRun's.
  [[nodiscard]] bool step();
  /// The tick just lived through.
  [[nodiscard]] const TickRecord& last() const { return *last_; }
  [[nodiscard]] const ControlLoop& loop() const { return loop_; }
  [[nodiscard]] const Tracker& tracker() const { return loop_.tracker(); }
  [[nodiscard]] const Planner& planner() const { return planner_; }
  [[nodiscard]] const ControlSetup& setup() const { return run_.setup(); }
  [[nodiscard]] const std::filesystem::path& file() const { return run_.file(); }
  /// RecordedRun's.
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
