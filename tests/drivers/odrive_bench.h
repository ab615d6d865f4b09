#pragma once
#include <cmath>

#include "hil/emulators/odrive_node.h"
#include "drivers/motor/odrive_base.h"
#include "tests/drivers/motor_bench.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

/// The emulated axis ramps with 20 turns/s2: 10 rad/s2 of the wheel, of which a stop is owed 8.
inline odrive::BaseSetup two_odrives() {
  odrive::BaseSetup setup;
  setup.axes = {odrive::AxisSetup{3, 2.0}, odrive::AxisSetup{4, -2.0}};  // the right motor looks the other way
  setup.stop = {.brake_radps2 = 8.0, .tolerance_radps = 0.5};
  return setup;
}

struct OdriveBench : MotorBench<odrive::OdriveBase, odrive::BaseSetup, emulators::OdriveNode> {
  explicit OdriveBench(const odrive::BaseSetup& setup = two_odrives()) : MotorBench(setup, 3, 4) {}
  void bring_to_two_radps() {
    REQUIRE(armed() == "armed");
    drive(0.0, 0.0, 20);
    drive(2.0, 2.0, 50);
    REQUIRE(base.trouble() == DriveTrouble::kNone);
    REQUIRE(left.velocity() == Approx(4.0));
    REQUIRE(right.velocity() == Approx(-4.0));
  }
  [[nodiscard]] bool is_at_rest() const {
    return std::fabs(left.velocity()) < 1e-9 && std::fabs(right.velocity()) < 1e-9;
  }
};

}  // namespace jaywalk::tests
