// ODrive and VESC pairs over a kernel's virtual bus; where there is none these tests say "skipped": kernel_bus_test.cc.
#include <net/if.h>

#include <array>
#include <chrono>
#include <iostream>

#include "drivers/can/socketcan.h"
#include "tests/drivers/drive_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

bool is_missing() {
  if (::if_nametoindex("vcan0") != 0) return false;
  std::cout << "skipped: no interface vcan0\n";
  return true;
}

SocketCan place_on_bus(Clock& clock, bool extended) {
  const std::array all{CanFilter{.id = 0, .mask = 0, .extended = extended}};
  return {open_can("vcan0", all), clock};
}

/// Controller and motors have a socket each; frames have real ages, and this machine may be busy.
template <class Base, class Setup, class Node>
struct Bench {
  Bench(const Setup& setup, std::uint8_t left_id, std::uint8_t right_id, bool extended)
      : controller(place_on_bus(clock, extended)),
        left_socket(place_on_bus(clock, extended)),
        right_socket(place_on_bus(clock, extended)),
        left(left_socket, left_id),
        right(right_socket, right_id),
        base(controller, clock, setup) {
    clock.plant = [this](Time now) { left.step(now), right.step(now); };
  }
  void drive(double speed_radps, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      wheels = base.latest();
      base.command({clock.now(), speed_radps, speed_radps});
      clock.sleep_until(clock.now() + 20ms);
    }
  }

  tests::PlantClock clock;
  SocketCan controller, left_socket, right_socket;
  Node left, right;
  Base base;
  WheelState wheels;
};

}  // namespace

TEST_CASE("ODrives over the kernel's bus are proved, drive, and stop when one of them fails", "[can]") {
  if (is_missing()) return;
  odrive::BaseSetup setup = tests::Odrive::setup();
  setup.silence_limit = setup.stop.fresh = 2s;
  Bench<odrive::OdriveBase, odrive::BaseSetup, emulators::OdriveNode> bench(setup, 3, 4, false);
  REQUIRE(bench.base.arm().size() == 2);
  bench.drive(0.0, 20);
  bench.drive(2.0, 50);
  CHECK(bench.left.velocity() == Approx(4.0));
  CHECK(bench.wheels.right_radps == Approx(2.0));
  bench.left.set_lasting_error(0x1000);
  bench.drive(2.0, 20);
  CHECK(bench.wheels.trouble == DriveTrouble::kDriveFault);
  CHECK(bench.right.velocity() == 0.0);
  CHECK(bench.controller.health().frames_lost == 0);
}

TEST_CASE("VESCs over the kernel's bus are read back, drive, and stop when one of them fails", "[can]") {
  if (is_missing()) return;
  vesc::BaseSetup setup = tests::Vesc::setup();
  setup.silence_limit = setup.stop.fresh = 2s;
  Bench<vesc::VescBase, vesc::BaseSetup, emulators::VescNode> bench(setup, 23, 24, true);
  REQUIRE(bench.base.arm().size() == 2);
  bench.drive(0.0, 10);
  bench.drive(2.0, 50);
  CHECK(bench.left.erpm() == Approx(3000.0));
  CHECK(bench.wheels.right_radps == Approx(2.0));
  bench.left.raise_fault(3);
  bench.drive(2.0, 20);
  CHECK(bench.wheels.trouble == DriveTrouble::kDriveFault);
  CHECK(bench.right.erpm() == 0.0);
  CHECK(bench.controller.health().frames_lost == 0);
}
