#include "drivers/panel/joystick_watch.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>

namespace jaywalk::panel {

JoystickWatch::~JoystickWatch() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void JoystickWatch::start(int priority) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] {
    for (; !ending_; clock_.sleep_until(clock_.now() + kPeriod)) step();
  });
  ::pthread_setname_np(thread_.native_handle(), "joystick");
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
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
