#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/hal.h"

namespace jaywalk {

/// What the loop's thread asks of the kernel.
struct RealtimeWishes {
  int priority = 80;  ///< of SCHED_FIFO, 1 to 98; 0: an ordinary thread
  bool lock_memory = true;
  std::optional<int> cpu = {};  ///< a processor of its own
  bool required = true;         ///< a run does not start without what it asks for here
};

/// Priorities where processors are few: the guard, the loop, the scanner's thread, then those that take a person's
/// orders: the joystick's and the control socket's. Planner and report are ordinary threads and hold up none of these.
[[nodiscard]] constexpr int guard_priority(const RealtimeWishes& w) { return w.priority > 0 ? w.priority + 1 : 0; }
[[nodiscard]] constexpr int laser_priority(const RealtimeWishes& w) {
  return w.priority > 1 ? w.priority - 1 : w.priority;
}
[[nodiscard]] constexpr int order_priority(const RealtimeWishes& w) {
  return w.priority > 2 ? w.priority - 2 : w.priority;
}

/// Keeps all memory from being paged out; once, at start. Returns what was not permitted and what would permit it.
std::vector<std::string> lock_memory();

/// Keeps processors, where permitted, from deep sleep, out of which they wake late, while the process lives (PM QoS).
void keep_processors_awake() noexcept;

/// Asks the kernel for what the calling thread wishes, except memory, and touches its stack. The same answer.
std::vector<std::string> enter_realtime(const RealtimeWishes& wishes);

/// Throws StartupError for the first of what was not permitted, where it is required.
void require_realtime(const RealtimeWishes& wishes, const std::vector<std::string>& not_permitted);

/// Of the calling thread since it began: those that cost a look into memory's tables, and those that waited for a disk.
struct PageFaults {
  std::uint64_t minor = 0, major = 0;
  [[nodiscard]] PageFaults since(const PageFaults& before) const noexcept {
    return {minor - before.minor, major - before.major};
  }
};
[[nodiscard]] PageFaults page_faults() noexcept;

/// CLOCK_MONOTONIC: nanoseconds since boot, never set back. Any thread.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return Time{std::chrono::steady_clock::now().time_since_epoch()}; }
  /// An absolute wake-up: however long the last tick took, the next is not put off.
  void sleep_until(Time wake) noexcept override;
};

}  // namespace jaywalk
