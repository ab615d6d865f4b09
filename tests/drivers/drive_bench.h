#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/can/in_process_bus.h"
#include "hal/types/errors.h"
#include "tests/drivers/drive_plant.h"
#include "tests/drivers/frames.h"
#include "tests/drivers/watched_port.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

/// A drive base and two emulated drives on one bus, time moved on by hand.
struct DriveBench {
  explicit DriveBench(const canopen::DriveBaseSetup& setup = two_axes()) : base(port, clock, setup) {
    clock.nodes = {&left, &right};
  }
  /// A tick is `tick` long.
  void drive(double left_radps, double right_radps, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      wheels = base.latest();
      base.command({clock.now(), left_radps, right_radps});
      clock.sleep_until(clock.now() + tick);
    }
  }
  void bring_to_two_radps() {
    report = base.arm();
    drive(0.0, 0.0, 10);
    drive(2.0, 2.0, 50);
    REQUIRE(left.velocity() == Approx(2000.0));
    REQUIRE(right.velocity() == Approx(-2000.0));
  }
  std::string refusal() {
    try {
      report = base.arm();
    } catch (const StartupError& error) {
      return error.what();
    }
    return "armed";
  }
  /// Another program on the bus says this.
  void stranger_says(const CanFrame& frame) { REQUIRE(bus.port(3).send(frame) == SendResult::kQueued); }
  [[nodiscard]] bool is_at_rest() const { return left.velocity() == 0.0 && right.velocity() == 0.0; }

  Duration tick = std::chrono::milliseconds(20);
  PlantClock clock;
  InProcessBus bus{clock, 1};
  WatchedPort port{bus.port(0), clock};
  emulators::Cia402Node left{bus.port(1), 5};
  emulators::Cia402Node right{bus.port(2), 6};
  canopen::CanopenDriveBase base;
  WheelState wheels;
  std::vector<std::string> report;
};

}  // namespace jaywalk::tests
