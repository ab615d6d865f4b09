// Drives that restart, drop out or come back: nothing has torque before the whole proof of both (SAFETY 15).
#include <chrono>

#include "tests/drivers/odrive_bench.h"
#include "tests/drivers/vesc_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

/// An emergency stop that cuts the left drive's power for half a second, and a robot that stands.
template <class Bench>
void cut_power(Bench& bench) {
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.left.pull_cable();
  bench.drive(0.0, 0.0, 25);
  bench.left.restart();
  bench.left.plug_cable();
  bench.drive(0.0, 0.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveSilent);
  CHECK_FALSE(bench.base.is_proved());
}

}  // namespace

TEST_CASE("ODrives are proved whole after a power cut and then both wheels obey") {
  tests::OdriveBench bench;
  cut_power(bench);
  bench.base.reset();
  bool left_held = false;
  bool right_held = false;
  for (int k = 0; k < 60 && !bench.base.is_proved(); ++k) {
    bench.drive(2.0, 2.0, 1);  // nothing that is wanted meanwhile turns a wheel
    left_held = left_held || bench.left.is_enabled();
    right_held = right_held || bench.right.is_enabled();
    REQUIRE(bench.is_at_rest());
  }
  CHECK(bench.base.is_proved());
  CHECK(left_held);
  CHECK(right_held);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());  // a command of zero is still owed
  bench.drive(0.0, 0.0, 20);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(4.0));
  CHECK(bench.right.velocity() == Approx(-4.0));
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("an ODrive that lost its watchdog while it was off is not enabled again") {
  tests::OdriveBench bench;
  cut_power(bench);
  bench.left.set_watchdog(0ms);
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.left.is_enabled());
  CHECK_FALSE(bench.base.is_proved());
  bench.left.set_watchdog(60ms);
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(4.0));
}

TEST_CASE("the proof after a return is that of both ODrives") {
  tests::OdriveBench bench;
  cut_power(bench);
  bench.right.set_watchdog(0ms);
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a reset while an ODrive is still away fails its proof") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.left.pull_cable();
  bench.drive(0.0, 0.0, 25);
  bench.base.reset();
  bench.drive(0.0, 0.0, 30);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);  // a second to come back
  bench.drive(0.0, 0.0, 30);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.left.restart();
  bench.left.plug_cable();
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
}

TEST_CASE("an ODrive that turns when it is held in its proof is let go") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.left.stick();
  bench.drive(0.0, 0.0, 200);  // its watchdog lets it go; the old target stays
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  CHECK_FALSE(bench.left.is_enabled());
  bench.drive(0.0, 0.0, 100);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a restart that is over before anything is missed shows in an ODrive's position") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 50);
  const double turned_rad = bench.wheels.left_rad;
  bench.left.restart();
  bench.drive(0.0, 0.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveRestarted);
  CHECK(bench.wheels.left_rad == Approx(turned_rad));
}

TEST_CASE("what restarts between arming and the first command is proved again by itself") {
  tests::OdriveBench odrives;
  REQUIRE(odrives.armed() == "armed");
  odrives.left.pull_cable();
  odrives.clock.sleep_until(odrives.clock.now() + 200ms);
  odrives.left.restart();
  odrives.left.plug_cable();
  odrives.drive(0.0, 0.0, 1);
  CHECK_FALSE(odrives.base.is_proved());
  odrives.drive(0.0, 0.0, 60);
  CHECK(odrives.base.trouble() == DriveTrouble::kNone);
  odrives.drive(2.0, 2.0, 50);
  CHECK(odrives.left.velocity() == Approx(4.0));
}

TEST_CASE("a reset without any trouble of the drives proves nothing anew") {
  tests::OdriveBench odrives;
  odrives.bring_to_two_radps();
  odrives.drive(0.0, 0.0, 20);
  odrives.base.reset();
  CHECK(odrives.base.is_proved());
  odrives.drive(0.0, 0.0, 2);
  CHECK(odrives.base.is_enabled());
  tests::VescBench vescs;
  vescs.bring_to_two_radps();
  vescs.drive(0.0, 0.0, 20);
  vescs.base.reset();
  CHECK(vescs.base.is_proved());
  vescs.drive(0.0, 0.0, 2);
  CHECK(vescs.base.is_enabled());
}

TEST_CASE("VESCs are read back again after a power cut and then both wheels obey") {
  tests::VescBench bench;
  cut_power(bench);
  bench.base.reset();
  for (int k = 0; k < 60 && !bench.base.is_proved(); ++k) {
    bench.drive(2.0, 2.0, 1);
    REQUIRE(bench.is_at_rest());
  }
  CHECK(bench.base.is_proved());
  bench.drive(0.0, 0.0, 10);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.erpm() == Approx(3000.0));
  CHECK(bench.right.erpm() == Approx(-3000.0));
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("a VESC that lost its timeout while it was off is not enabled again") {
  tests::VescBench bench;
  cut_power(bench);
  bench.left.set_timeout(1000, 0.0F);
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.base.is_enabled());
  bench.left.set_timeout(90, 10.0F);
  bench.base.reset();
  bench.drive(0.0, 0.0, 30);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.erpm() == Approx(3000.0));
}

TEST_CASE("a VESC whose tachometer jumps has restarted") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  const double turned_rad = bench.wheels.left_rad;
  bench.left.restart();
  bench.drive(2.0, 2.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveRestarted);
  CHECK(bench.wheels.left_rad >= turned_rad);
  CHECK(bench.right.erpm() == 0.0);
}
