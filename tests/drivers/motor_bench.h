#pragma once
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "drivers/can/in_process_bus.h"
#include "hal/hal.h"
#include "hal/types/errors.h"
#include "tests/drivers/watched_port.h"
#include "tests/support/allocation_guard.h"

namespace jaywalk::tests {

/// Time that moves two emulated motors on, a millisecond at a time, while the controller sleeps.
template <class Node>
class MotorClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override {
    while (now_ < wake) {
      now_ += std::chrono::milliseconds(1);
      for (Node* node : nodes) node->step(now_);
    }
  }
  std::array<Node*, 2> nodes{};

 private:
  Time now_{};
};

/// Two emulated motors and the drive base that drives them, on a bus in this process.
template <class Base, class Setup, class Node>
struct MotorBench {
  MotorBench(const Setup& setup, std::uint8_t left_id, std::uint8_t right_id)
      : left(bus.port(1), left_id), right(bus.port(2), right_id), port(bus.port(0), clock), base(port, clock, setup) {
    clock.nodes = {&left, &right};
  }
  /// A tick is `tick` long.
  void drive(double left_radps, double right_radps, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      const AllocationGuard guard;
      wheels = base.latest();
      base.command({clock.now(), left_radps, right_radps});
      heap_calls += guard.calls();
      clock.sleep_until(clock.now() + tick);
    }
  }
  /// What arming said, "armed" where it said yes.
  std::string armed() {
    try {
      report = base.arm();
    } catch (const StartupError& error) {
      return error.what();
    }
    return "armed";
  }

  Duration tick = std::chrono::milliseconds(20);
  MotorClock<Node> clock;
  InProcessBus bus{clock, 1};
  Node left, right;
  WatchedPort port;
  Base base;
  WheelState wheels;
  std::vector<std::string> report;
  std::uint64_t heap_calls = 0;
};

}  // namespace jaywalk::tests
