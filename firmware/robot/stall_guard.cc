#include "firmware/robot/stall_guard.h"

#include "drivers/wire/thread_without_signals.h"
#include "firmware/robot/realtime.h"

namespace jaywalk {

StallGuard::StallGuard(EmergencyBrake& brake, Clock& clock, Duration limit) noexcept
    : brake_(brake), clock_(clock), limit_(limit) {}

StallGuard::~StallGuard() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void StallGuard::start(int priority) {
  thread_ = thread_without_signals("guard", [this, priority] { watch(priority); });
}

void StallGuard::watch(int priority) noexcept {
  static_cast<void>(enter_realtime({.priority = priority}));  // the loop's thread tells what is not permitted
  bool stalled = false;
  while (!ending_) {
    clock_.sleep_until(clock_.now() + limit_ / 4);
    const std::int64_t beat = beat_.load(std::memory_order_acquire);
    const bool late = beat != kResting && clock_.now() - Time{Duration{beat}} > limit_;
    if (late) brake_.brake();
    if (late && !stalled) stalls_.fetch_add(1, std::memory_order_relaxed);
    stalled = late;
  }
}

}  // namespace jaywalk
