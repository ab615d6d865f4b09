#pragma once
#include <time.h>

#include "planner/planner.h"

namespace jaywalk::field {

/// The clocks that a plan is timed by, read when it was made. The difference of two is what lay between them.
class PlanClock {
 public:
  template <class Executor>
  explicit PlanClock(const Executor& executor)
      : at_{ms_of(CLOCK_MONOTONIC), ms_of(CLOCK_THREAD_CPUTIME_ID), executor.took_ms()} {}

  PlanTook operator-(const PlanClock& before) const noexcept {
    return {at_.ms - before.at_.ms, at_.processor_ms - before.at_.processor_ms, at_.device_ms - before.at_.device_ms};
  }

 private:
  static double ms_of(clockid_t clock) noexcept {
    timespec now{};
    clock_gettime(clock, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }
  PlanTook at_;
};

}  // namespace jaywalk::field
