#pragma once
// A control loop under way, with everything that watches it: recorder, report, stopwatch.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorder.h"
#include "firmware/recording/run_folders.h"
#include "firmware/run_sample.h"

namespace jaywalk {

/// Builds the controller for a setup on the given devices and runs it a tick at a time. What is slow (disk, tables)
/// happens between ticks.
class LoopRunner {
 public:
  /// Makes the loop's planner.
  using MakePlanner = std::function<ChosenPlanner(const ControlSetup&)>;

  /// Where the run's files go, and whether it is recorded.
  struct Files {
    std::filesystem::path folder;
    PartsKept parts = {};
    bool records = true;  ///< recording.jwr, in the folder or, where they are wanted, in its parts
  };

  /// `observer` is told of the run, and outlives it. Without `make`, make_planner() does. Throws StartupError.
  LoopRunner(const ControlSetup& setup, Hal hal, const Files& files, TickObserver& observer,
             const MakePlanner& make = {});

  /// Sleeps until the next tick is due and lives through it.
  const TickRecord& step() { return step_at(due_); }
  /// The same for a tick at a time that the caller knows; the next is due a period later.
  const TickRecord& step_at(Time due);
  /// For a loop with a thread of its own: a tick and nothing that is slow; neither sleeps nor writes.
  const TickRecord& tick_at(Time due) noexcept;
  /// The thread that reports: writes out what has been recorded. Where the disk takes no more of a file, says so once
  /// and gives the ticks from then on Reason::kNotRecorded; so does report().
  void drain();
  /// What the tables are to say for a time of the loop's.
  using OwnTime = std::function<Time(Time)>;
  /// Tells the observer of the last step. `truth` may be null; without `own` tables say the loop's times.
  void report(const TrueState* truth, const OwnTime& own = {});
  /// The thread that reports: tells it of a tick that was kept.
  void report(const RunSample& sample);
  /// Closes the recording and finishes the observer; returns the file to look at first. Call once, after the last
  /// step. Throws StartupError where the disk does not take the summary.
  std::filesystem::path finish(RunEnd end);
  /// When all is written: throws StartupError naming the first file that the disk did not take all of.
  void require_recorded() const;

  [[nodiscard]] const ControlLoop& loop() const { return loop_; }
  [[nodiscard]] const TickRecord& last() const { return *record_; }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  [[nodiscard]] const Planner& planner() const { return *chosen_.planner; }
  /// How long the last tick took.
  [[nodiscard]] Duration last_took() const { return took_; }
  /// Ticks that took longer than a period of the wall clock.
  [[nodiscard]] std::uint64_t overruns() const { return overruns_; }

 private:
  void begin_part() noexcept;
  void tell_losses();
  void tell_loss(const std::string& complaint);

  ControlSetup setup_;
  Clock& clock_;
  OutFolder out_;
  RunParts parts_;
  ChosenPlanner chosen_;
  Recorder recorder_;
  ControlLoop loop_;
  TickObserver& observer_;
  std::optional<std::filesystem::path> recording_;  ///< where one is made, whole
  Time due_;
  const TickRecord* record_ = nullptr;
  Duration took_{0};
  std::uint32_t plan_reported_ = 0;
  std::uint64_t overruns_ = 0;
  std::vector<std::string> losses_;  ///< told already
};

}  // namespace jaywalk
