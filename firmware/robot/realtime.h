#pragma once
#include <optional>
#include <string>
#include <vector>

namespace jaywalk {

/// What the loop's thread asks of the kernel.
struct RealtimeWishes {
  int priority = 80;  ///< of SCHED_FIFO, 1 to 98; 0: an ordinary thread
  bool lock_memory = true;
  std::optional<int> cpu = {};  ///< a processor of its own
};

/// Who goes before whom where processors are few: the guard, the loop, then whoever takes in what the scanner sends.
/// After them come those that take a person's orders: the joystick's and the control socket's. Planner and report are
/// ordinary threads: a plan that takes long holds up none of these.
[[nodiscard]] constexpr int guard_priority(const RealtimeWishes& w) { return w.priority > 0 ? w.priority + 1 : 0; }
[[nodiscard]] constexpr int laser_priority(const RealtimeWishes& w) {
  return w.priority > 1 ? w.priority - 1 : w.priority;
}
[[nodiscard]] constexpr int order_priority(const RealtimeWishes& w) {
  return w.priority > 2 ? w.priority - 2 : w.priority;
}

/// Keeps all memory, had and to come, from being paged out. Start-up only, once a process.
/// Returns what was not permitted and what would permit it, a line each; empty: all is well.
std::vector<std::string> lock_memory();

/// Asks the kernel for what the calling thread wishes, except memory, and touches its stack. The same answer.
std::vector<std::string> enter_realtime(const RealtimeWishes& wishes);

}  // namespace jaywalk
