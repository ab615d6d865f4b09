#include "firmware/robot/stall_guard.h"

#include "firmware/robot/realtime.h"

namespace jaywalk {

StallGuard::StallGuard(EmergencyBrake& brake, Clock& clock, Duration limit, int priority)
    : brake_(brake), clock_(clock), limit_(limit), priority_(priority), thread_([this] { watch(); }) {}

StallGuard::~StallGuard() {
  ending_ = true;
  thread_.join();
}

void StallGuard::watch() noexcept {
  static_cast<void>(enter_realtime({.priority = priority_}));  // the loop's thread tells what is not permitted
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
