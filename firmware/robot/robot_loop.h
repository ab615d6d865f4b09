#pragma once
// The loop's thread on a robot: wakes at fixed times, lives through ticks, tells how it goes.
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/laser/scanner_connection.h"
#include "drivers/wired_drive.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorder.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/service_manager.h"
#include "firmware/run_sample.h"

namespace jaywalk {

/// Watches the loop from a thread of its own: when no beat came for `limit` it brakes, and again every quarter of it
/// until the loop beats again (SAFETY: a stall over 100 ms). The supervisor counts the ticks that were missed.
class StallGuard {
 public:
  /// `clock` outlives it. The brake is used by the guard's thread alone.
  StallGuard(EmergencyBrake brake, Clock& clock, Duration limit) noexcept
      : brake_(std::move(brake)), clock_(clock), limit_(limit) {}
  ~StallGuard();

  /// Starts the thread, with a priority of SCHED_FIFO (0: an ordinary one).
  void start(int priority);
  /// The loop's thread, at every tick. Watching begins with the first.
  void beat(Time now) noexcept { beat_.store(now.time_since_epoch().count(), std::memory_order_release); }
  /// The loop has ended as it should.
  void rest() noexcept { beat_.store(kResting, std::memory_order_release); }
  /// How often the loop stalled. Any thread.
  [[nodiscard]] std::uint64_t stalls() const noexcept { return stalls_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kResting = INT64_MIN;

  void watch(int priority) noexcept;

  EmergencyBrake brake_;
  Clock& clock_;
  Duration limit_;
  std::atomic<std::int64_t> beat_{kResting};
  std::atomic<std::uint64_t> stalls_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// What the report wants to know of one tick.
struct TickTrace {
  TickRecord record;
  FixedVector<Track, kMaxTracks> tracks;
  Duration took{0};
  std::optional<PlanTook> plan_took;
  RunStatus status;
};

/// What the loop asks of its devices beyond the HAL.
struct LoopDevices {
  WiredDrive& drive;
  std::span<const std::unique_ptr<ScannerConnection>> lasers;
  const CanBus& bus;
  ResetGate& resets;
};

/// A tick that comes a period late or more is missed: it is counted and never made up for. Nothing in this thread
/// allocates, locks, logs or waits for anything but its next tick.
class RobotLoop {
 public:
  using Traces = Ring<TickTrace, 128>;

  /// All outlive it.
  RobotLoop(LoopRunner& runner, const LoopDevices& devices, OperatorDesk& desk, Clock& clock, StallGuard& guard,
            TickObserver& observer);
  ~RobotLoop();

  /// Before the drives are armed: starts the thread, which waits for start(). Returns what the kernel did not permit.
  [[nodiscard]] std::vector<std::string> prepare(const RealtimeWishes& wishes);
  /// The drives are armed: the prepared thread begins to tick.
  void start() noexcept;
  /// Takes no more goals, ramps to rest, disarms the drives and ends the thread; traces go on until has_ended().
  void end() noexcept;
  [[nodiscard]] bool has_ended() const noexcept { return ended_; }

  /// So far; any thread.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_.load(std::memory_order_acquire); }

  /// The tick that is due at `due`, now: for the loop's thread, or by hand where none was started.
  void tick(Time due) noexcept;

  [[nodiscard]] Traces& traces() noexcept { return traces_; }
  /// After has_ended().
  [[nodiscard]] const LoopTimes& times() const noexcept { return times_; }

 private:
  enum class Stage : std::uint8_t { kPreparing, kPrepared, kStarted, kGivenUp };
  void run(const RealtimeWishes& wishes);
  void live() noexcept;
  void note_times(Time began) noexcept;
  [[nodiscard]] Time next_due(Time due) noexcept;
  void tell(const TickRecord& t) noexcept;
  void trace(const TickRecord& t) noexcept;
  void disarm(Time due) noexcept;
  /// Of the faster wheel; NaN where its feedback is too old to tell.
  [[nodiscard]] double speed_mps(const WheelState& wheels, Time now) const noexcept;

  LoopRunner& runner_;
  LoopDevices devices_;
  OperatorDesk& desk_;
  Clock& clock_;
  StallGuard& guard_;
  TickObserver& observer_;
  Duration period_;
  RunStatus status_;
  PlaceCheck place_check_;
  Traces traces_;
  std::uint32_t plan_traced_ = 0;
  LoopTimes times_;
  std::optional<PageFaults> faults_before_;  ///< of this thread, at its first tick
  std::vector<std::string> not_permitted_;
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<Stage> stage_{Stage::kPreparing};
  std::atomic<bool> ending_{false}, ended_{false};
  std::thread thread_;
};

}  // namespace jaywalk
