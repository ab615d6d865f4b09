#include "firmware/robot/steady_clock.h"

#include <time.h>

#include <cerrno>

namespace jaywalk {

Time SteadyClock::now() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return Time{std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec)};
}

void SteadyClock::sleep_until(Time wake) noexcept {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(wake.time_since_epoch());
  const timespec until{.tv_sec = seconds.count(), .tv_nsec = (wake.time_since_epoch() - seconds).count()};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace jaywalk
