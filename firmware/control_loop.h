#pragma once
// The fixed-rate loop. One tick: sense, estimate, plan, act, record.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware/backends.h"
#include "firmware/control_setup.h"
#include "firmware/estimator.h"
#include "firmware/recording/recorder.h"
#include "firmware/recording/run_folders.h"
#include "firmware/run_sample.h"
#include "firmware/safety/beam_filter.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/supervisor.h"
#include "hal/hal.h"
#include "planner/cost_to_go/planner.h"
#include "planner/motion/motion.h"
#include "planner/motion/robot_body.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk {

/// Owns the controller's parts; the devices, the planner and the recorder are lent and outlive it.
/// The constructor allocates; tick() never does, never throws and never waits. Thread: the loop's.
class ControlLoop {
 public:
  ControlLoop(const ControlSetup& setup, Hal hal, Planner& planner, Recorder& recorder);

  /// Lives through one tick; call once a period with the clock's time. Returns the tick's record, valid until the next.
  const TickRecord& tick(Time now) noexcept;

  [[nodiscard]] const ControlSetup& setup() const noexcept { return setup_; }
  [[nodiscard]] const Estimator& estimator() const noexcept { return estimator_; }
  [[nodiscard]] const Tracker& tracker() const noexcept { return estimator_.tracker(); }
  [[nodiscard]] const Plan& plan() const noexcept { return *plan_; }
  [[nodiscard]] const motion::Motion& motion() const noexcept { return *motion_; }
  [[nodiscard]] Mode mode() const noexcept { return supervisor_.mode(); }

 private:
  void read_devices(TickRecord& t) noexcept;
  void take_plan(TickRecord& t) noexcept;
  void ask(TickRecord& t) noexcept;
  void permit(TickRecord& t) noexcept;
  void send(TickRecord& t) noexcept;
  /// With a new scan or plan: how to move from the next tick on, and what to plan next.
  void think_on(TickRecord& t, bool new_scan) noexcept;
  [[nodiscard]] bool is_steered(const TickRecord& t) const noexcept {
    return t.input.steers && setup_.steering != StickUse::kNone;
  }
  [[nodiscard]] motion::Intent intent(const TickRecord& t) const noexcept;
  [[nodiscard]] motion::World world(const TickRecord& t) const noexcept;
  /// At that scan, its scanner's newest.
  [[nodiscard]] Pose2 map_from_laser(const LaserScan& scan) const noexcept;

  ControlSetup setup_;
  Hal hal_;
  Planner& planner_;
  Recorder& recorder_;
  std::vector<BeamFilter> beam_filters_;  ///< of each scanner
  motion::ZoneSpeed zone_speed_{};        ///< this tick's
  Estimator estimator_;
  std::unique_ptr<motion::Motion> motion_;  ///< never null
  Latency latency_;
  KnownWalls known_walls_;
  Supervisor supervisor_;
  const Plan* plan_;                                    ///< what collect() last answered, never null
  Time asked_ = kNever;                                 ///< when a plan was asked for last
  Twist2 driven_;                                       ///< what the wheels were last asked for
  WheelCommand sent_;                                   ///< and what that was for the drive
  std::uint32_t plan_noted_ = 0, plan_decided_on_ = 0;  ///< their sequences
};

/// Builds the controller for a setup and runs it a tick at a time. What is slow (disk, tables) happens between ticks.
class LoopRunner {
 public:
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

  const TickRecord& step() { return step_at(due_); }
  /// The same for a tick at a time that the caller knows; the next is due a period later.
  const TickRecord& step_at(Time due);
  /// For a loop with a thread of its own: a tick and nothing that is slow; neither sleeps nor writes.
  const TickRecord& tick_at(Time due) noexcept;
  /// The thread that reports: writes out what has been recorded. A file of which the disk takes no more is told once,
  /// and from then on ticks have Reason::kNotRecorded; so does report().
  void drain();
  /// What the tables are to say for a time of the loop's.
  using OwnTime = std::function<Time(Time)>;
  /// Tells the observer of the last step. `truth` may be null; without `own` tables say the loop's times.
  void report(const TrueState* truth, const OwnTime& own = {});
  /// The thread that reports: tells it of a tick that was kept.
  void report(const RunSample& sample);
  /// Once, after the last step: closes the recording and finishes the observer; returns the file to look at first.
  /// Throws StartupError where the disk does not take the summary.
  std::filesystem::path finish(RunEnd end);
  /// When all is written: throws StartupError naming the first file that the disk did not take all of.
  void require_recorded() const;

  [[nodiscard]] const ControlLoop& loop() const { return loop_; }
  [[nodiscard]] const TickRecord& last() const { return *record_; }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  [[nodiscard]] const Planner& planner() const { return *chosen_.planner; }
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
  std::filesystem::path recording_;  ///< where one is made, whole; else empty
  Time due_;
  const TickRecord* record_ = nullptr;
  Duration took_{0};
  std::uint32_t plan_reported_ = 0;
  std::uint64_t overruns_ = 0;
  std::vector<std::string> losses_;  ///< told already
};

}  // namespace jaywalk
