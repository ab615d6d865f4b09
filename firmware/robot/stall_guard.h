#pragma once
#include <atomic>
#include <cstdint>
#include <thread>

#include "drivers/wired_drive.h"

namespace jaywalk {

/// Watches the loop from a thread of its own: when no beat came for `limit` it brakes, and again every quarter of it
/// until the loop beats again (SAFETY: a stall over 100 ms). What the loop does after that is the supervisor's matter:
/// it counts the ticks that were missed.
class StallGuard {
 public:
  /// Both outlive it. The brake is used by the guard's thread alone.
  StallGuard(EmergencyBrake& brake, Clock& clock, Duration limit) noexcept;
  ~StallGuard();
  StallGuard(const StallGuard&) = delete;
  StallGuard& operator=(const StallGuard&) = delete;

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

  EmergencyBrake& brake_;
  Clock& clock_;
  Duration limit_;
  std::atomic<std::int64_t> beat_{kResting};
  std::atomic<std::uint64_t> stalls_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace jaywalk
