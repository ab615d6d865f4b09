#pragma once
#include "hal/hal.h"

namespace jaywalk::tests {

/// A clock that a test moves on by hand.
class HandClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override { now_ = wake > now_ ? wake : now_; }

 private:
  Time now_{};
};

}  // namespace jaywalk::tests
