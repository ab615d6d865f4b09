#pragma once
// How loop and robot tell the rest of the world: tables, pictures, MCAP and live page implement this in apps.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/run_sample.h"

namespace jaywalk {

struct ControlSetup;

/// Observes a run. Every function does nothing unless it is overridden.
class TickObserver {
 public:
  virtual ~TickObserver() = default;

  /// Before the first tick. `tables`: where what grows goes, `out` or its first part. Throws StartupError.
  virtual void begin(const std::filesystem::path& /*out*/, const std::filesystem::path& /*tables*/,
                     const ControlSetup& /*setup*/) {}

  /// Loop's thread, after each tick: copies what it wants; neither allocates nor waits.
  virtual void after_tick(const TickRecord& /*record*/, const ControlLoop& /*loop*/) noexcept {}
  /// Planner's thread, after each plan, which was made with `map`. The same limits.
  virtual void after_plan(const Planner& /*planner*/, const EvidenceMap& /*map*/, Time /*stamp*/) noexcept {}

  /// This and all functions below: the reporting thread; they may be slow. Called once for each tick that was kept.
  virtual void report(const RunSample& /*sample*/) {}
  /// Called about 50 times a second on a robot, also when no tick came.
  virtual void follow() {}
  /// Rows of ticks later than `last` go to the folder `part`. Throws StartupError where it cannot be made.
  virtual void continue_in(const std::filesystem::path& /*part*/, Time /*last*/) {}
  /// No more rows are written.
  virtual void end_tables() {}
  /// Bytes written to the current folder.
  [[nodiscard]] virtual std::uintmax_t bytes() const { return 0; }
  /// One line for each file that the disk did not take whole.
  [[nodiscard]] virtual std::vector<std::string> complaints() const { return {}; }
  [[nodiscard]] virtual bool is_losing() const { return false; }
  /// Once, after the last tick. Returns the file to look at first; empty: the run's folder. Throws StartupError where
  /// a file cannot be written whole.
  virtual std::filesystem::path finish(const RunEnd& /*end*/, const ControlLoop& /*loop*/, const Planner& /*planner*/) {
    return {};
  }
};

}  // namespace jaywalk
