#pragma once
#include "hal/hal.h"

namespace jaywalk {

/// CLOCK_MONOTONIC: nanoseconds since boot, never set back. Any thread.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override;
  /// An absolute wake-up: however long the last tick took, the next is not put off.
  void sleep_until(Time wake) noexcept override;
};

}  // namespace jaywalk
