#pragma once
// Clocks by which the wires' far end lives while the controller sleeps, in the thread that sleeps.
#include <algorithm>
#include <functional>

#include "firmware/robot/realtime.h"

namespace jaywalk::rig {

/// How long the far end stands still at most.
inline constexpr Duration kLivingStep = std::chrono::milliseconds(1);

/// Time that a test moves on by hand. Thread: one.
class HandLivingClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override {
    while (now_ < wake) {
      now_ += kLivingStep;
      if (live) live();
    }
  }
  std::function<void()> live;

 private:
  Time now_{};
};

/// Real time; any thread asks for it, one sleeps by it.
class RealLivingClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return steady_.now(); }
  void sleep_until(Time wake) noexcept override {
    do {
      if (live) live();
      steady_.sleep_until(std::min(wake, now() + kLivingStep));
    } while (now() < wake);
  }
  std::function<void()> live;

 private:
  SteadyClock steady_;
};

}  // namespace jaywalk::rig
