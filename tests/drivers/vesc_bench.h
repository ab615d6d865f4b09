#pragma once
#include <cmath>

#include "hil/emulators/vesc_node.h"
#include "drivers/motor/vesc_base.h"
#include "tests/drivers/motor_bench.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

/// The emulated motor ramps with 30000 erpm/s: 20 rad/s2 of the wheel, of which a stop is owed 15.
inline vesc::BaseSetup two_vescs() {
  vesc::BaseSetup setup;
  setup.axes = {vesc::AxisSetup{23, 25.0}, vesc::AxisSetup{24, -25.0}};  // the right motor looks the other way
  setup.stop = {.brake_radps2 = 15.0, .tolerance_radps = 0.5};
  return setup;
}

/// A wheel at 2 rad/s: 50 electrical turns a second, 3000 a minute; the emulated motor has that after 0.1 s.
struct VescBench : MotorBench<vesc::VescBase, vesc::BaseSetup, emulators::VescNode> {
  explicit VescBench(const vesc::BaseSetup& setup = two_vescs()) : MotorBench(setup, 23, 24) {}
  void bring_to_two_radps() {
    REQUIRE(armed() == "armed");
    drive(0.0, 0.0, 10);
    drive(2.0, 2.0, 50);
    REQUIRE(base.trouble() == DriveTrouble::kNone);
    REQUIRE(left.erpm() == Approx(3000.0));
    REQUIRE(right.erpm() == Approx(-3000.0));
  }
  [[nodiscard]] bool is_at_rest() const { return std::fabs(left.erpm()) < 1e-9 && std::fabs(right.erpm()) < 1e-9; }
};

}  // namespace jaywalk::tests
