#include "drivers/panel/joystick_watch.h"

#include <pthread.h>
#include <sched.h>

#include "drivers/wire/thread_without_signals.h"

namespace jaywalk::panel {

JoystickWatch::~JoystickWatch() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void JoystickWatch::start(int priority) {
  thread_ = thread_without_signals("joystick", [this] {
    for (; !ending_; clock_.sleep_until(clock_.now() + kPeriod)) step();
  });
  const sched_param wanted{.sched_priority = priority};
  if (priority > 0) ::pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &wanted);
}

void JoystickWatch::step() noexcept {
  const Time now = clock_.now();  // before it looks: what blocks there makes the report old
  joystick_.poll(now);
  reports_.publish({joystick_.state(), now});
}

JoystickState JoystickWatch::latest() noexcept {
  const Report& report = reports_.latest();
  if (age(report.looked, clock_.now()) <= kLongestAge) return report.state;
  JoystickState gone;
  gone.stops = report.state.stops;
  return gone;
}

}  // namespace jaywalk::panel
