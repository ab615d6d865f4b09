#pragma once
#include <chrono>
#include <functional>

#include "drivers/canopen/drive_base.h"
#include "hal/hal.h"
#include "hil/emulators/cia402_node.h"

namespace jaywalk::tests {

/// Time that moves emulated drives on, a millisecond at a time, while the controller sleeps.
class PlantClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override {
    while (now_ < wake) {
      now_ += std::chrono::milliseconds(1);
      if (plant) plant(now_);
      if (meanwhile) meanwhile();
    }
  }
  std::function<void(Time)> plant;
  std::function<void()> meanwhile;  ///< after each step

 private:
  Time now_{};
};

inline canopen::DriveBaseSetup two_axes() {
  canopen::DriveBaseSetup setup;
  setup.axes = {CanAxis{5, 1000.0}, CanAxis{6, -1000.0}};  // the right motor looks the other way
  setup.settings = {.controller_node = 1,
                    .controller_timeout_ms = 100,
                    .heartbeat_ms = 50,
                    .acceleration = 5000,
                    .deceleration = 5000,
                    .quick_stop = 20000};
  setup.stop = {.brake_radps2 = 10.0 / 3.0, .tolerance_radps = 0.3};  // the drives' ramps are half as steep again
  return setup;
}

}  // namespace jaywalk::tests
