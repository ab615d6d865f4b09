#pragma once
// How loop and robot tell the rest of the world: tables, pictures, MCAP and live page implement this in apps.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/run_sample.h"

namespace jaywalk {

struct ControlSetup;

/// Follows a run from outside; whatever it does not need it leaves as it is, which does nothing.
class TickObserver {
 public:
  virtual ~TickObserver() = default;

  /// Before the first tick. `tables`: where what grows goes, `out` or its first part. Throws StartupError.
  virtual void begin(const std::filesystem::path& /*out*/, const std::filesystem::path& /*tables*/,
                     const ControlSetup& /*setup*/) {}

  /// Loop's thread, after each tick: copies what it wants; neither allocates nor waits.
  virtual void after_tick(const TickRecord& /*record*/, const ControlLoop& /*loop*/) noexcept {}
  /// Planner's thread, after each plan that was made of `map`: the same.
  virtual void after_plan(const Planner& /*planner*/, const EvidenceMap& /*map*/, Time /*stamp*/) noexcept {}

  /// Reporting thread, here and below; may be slow. Each tick that was kept.
  virtual void report(const RunSample& /*sample*/) {}
  /// Some 50 times a second on a robot, also where no tick came.
  virtual void follow() {}
  /// Of ticks later than `last` is told in another folder. Throws StartupError where that cannot be.
  virtual void continue_in(const std::filesystem::path& /*part*/, Time /*last*/) {}
  /// Nothing is told in files any more.
  virtual void end_tables() {}
  /// Written since the last continue_in().
  [[nodiscard]] virtual std::uintmax_t bytes() const { return 0; }
  /// What the disk did not take, a line each; and whether there is such.
  [[nodiscard]] virtual std::vector<std::string> complaints() const { return {}; }
  [[nodiscard]] virtual bool is_losing() const { return false; }
  /// Once, after the last tick. Returns what a person looks at first; empty: the folder. Throws StartupError where the
  /// disk does not take all.
  virtual std::filesystem::path finish(const RunEnd& /*end*/, const ControlLoop& /*loop*/, const Planner& /*planner*/) {
    return {};
  }
};

}  // namespace jaywalk
