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

OperatorInput JoystickPanel::latest() noexcept {
  OperatorInput input = goals_.latest();
  const std::uint32_t stops_before = state_.stops;
  state_ = joystick_.latest();
  const bool stopped_meanwhile = state_.stops != stops_before;
  input.emergency_stop = input.emergency_stop || state_.stop || stopped_meanwhile;
  input.reset = input.reset || state_.reset;
  if (needs_dead_man_ && !state_.dead_man) input.has_goal = false;
  if (!stick_drives_) return input;
  input.stick = {state_.forward, state_.left};
  input.steers = !input.stick.is_centred() || !input.has_goal;
  if (input.steers) input.has_goal = false;
  return input;
}

}  // namespace jaywalk::panel
