#include "drivers/motor/odrive_base.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "tests/drivers/frames.h"
#include "tests/drivers/odrive_bench.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

TEST_CASE("an ODrive arms when its watchdog was seen to let go by itself") {
  tests::OdriveBench bench;
  REQUIRE(bench.armed() == "armed");
  REQUIRE(bench.report.size() == 2);
  // A watchdog of 60 ms and a heartbeat each 10 ms: seen 61 to 71 ms after the last command, and a step to hear it.
  const std::string& line = bench.report[0];
  CHECK(line.starts_with("ODrive node 3: watchdog: expired "));
  CHECK(line.ends_with(" ms after the last command"));
  const int after_ms = std::stoi(line.substr(std::string("ODrive node 3: watchdog: expired ").size()));
  CHECK(after_ms >= 61);
  CHECK(after_ms <= 72);
  CHECK_FALSE(bench.left.is_enabled());  // nothing has torque before a command of zero
  CHECK(bench.left.position() == 0.0);
}

TEST_CASE("looking at an ODrive hears it and gives it no torque") {
  tests::OdriveBench bench;
  CHECK(bench.base.inspect(1).starts_with("ODrive node 4: heartbeat and encoder estimates; errors 00000000h;"));
  CHECK_FALSE(bench.right.is_enabled());
  bench.left.pull_cable();
  bench.drive(0.0, 0.0, 1);
  CHECK_THROWS_AS(bench.base.inspect(0), StartupError);
}

TEST_CASE("an ODrive whose watchdog is off is not armed") {
  tests::OdriveBench bench;
  bench.right.set_watchdog(0ms);
  CHECK(bench.armed().starts_with(
      "ODrive node 4: watchdog: nothing said 100 ms after the last command: NOT PROVED; set enable_watchdog"));
  bench.drive(0.0, 0.0, 10);
  bench.drive(2.0, 2.0, 10);
  CHECK_FALSE(bench.base.is_enabled());
  CHECK(bench.is_at_rest());
}

TEST_CASE("an ODrive that says its watchdog expired and holds on is not armed") {
  tests::OdriveBench bench;
  bench.left.lie_about_watchdog();
  CHECK(bench.armed().find("and holds on: NOT PROVED") != std::string::npos);
  bench.clock.sleep_until(bench.clock.now() + 2ms);
  CHECK_FALSE(bench.left.is_enabled());  // it was told to let go
}

TEST_CASE("an ODrive whose watchdog is slow or hasty is not armed") {
  tests::OdriveBench bench;
  bench.left.set_watchdog(150ms);
  CHECK(bench.armed().starts_with("ODrive node 3: watchdog: nothing said 100 ms"));
  tests::OdriveBench hasty;
  hasty.left.set_watchdog(15ms);
  CHECK(hasty.armed().find("after the last command, too soon for two commands: NOT PROVED") != std::string::npos);
}

TEST_CASE("an unproved ODrive arms where that is allowed and it is on record") {
  odrive::BaseSetup setup = tests::two_odrives();
  setup.allow_unproved = true;
  tests::OdriveBench bench(setup);
  bench.left.set_watchdog(0ms);
  CHECK(bench.armed() == "armed");
  CHECK(bench.report[0] == "ODrive node 3: watchdog: nothing said 100 ms after the last command: NOT PROVED");
  CHECK(bench.report[1].find("NOT PROVED") == std::string::npos);
}

TEST_CASE("an ODrive that is not there or tells too little or is broken is not armed") {
  tests::OdriveBench silent;
  silent.right.pull_cable();
  CHECK(silent.armed() == "ODrive node 4: no heartbeat; see that the bus is up and the drive is powered");
  tests::OdriveBench blind;
  blind.left.withhold_estimates();
  CHECK(blind.armed().starts_with("ODrive node 3: no encoder estimates; "));
  tests::OdriveBench broken;
  broken.left.set_lasting_error(0x200);  // the battery is low
  CHECK(broken.armed().starts_with("ODrive node 3: errors 00000200h that do not clear: NOT PROVED; "));
}

TEST_CASE("wheels on ODrives turn as commanded and are felt in the same direction") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  CHECK(bench.wheels.left_radps == Approx(2.0));
  CHECK(bench.wheels.right_radps == Approx(2.0));
  // 4 turns/s at 20 turns/s2 are there after 0.2 s: 0.4 turns, then 0.8 s at 4: 3.6 turns are 1.8 rad; a tick late.
  CHECK(bench.wheels.left_rad == Approx(1.8).margin(0.05));
  CHECK(bench.wheels.right_rad == Approx(bench.wheels.left_rad).margin(0.01));
  CHECK(bench.wheels.sequence > 50);
  CHECK(bench.clock.now() - bench.wheels.stamp <= 30ms);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("nothing with ODrives moves before a command of zero") {
  tests::OdriveBench bench;
  REQUIRE(bench.armed() == "armed");
  bench.clock.sleep_until(bench.clock.now() + 1s);  // the watchdogs expire meanwhile
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.base.is_enabled());
  bench.drive(0.0, 0.0, 20);
  CHECK(bench.base.is_enabled());
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(4.0));
}

TEST_CASE("ODrives let go when the controller dies") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.clock.sleep_until(bench.clock.now() + 61ms);  // the last command was 20 ms ago
  CHECK_FALSE(bench.left.is_enabled());
  CHECK_FALSE(bench.right.is_enabled());
  bench.clock.sleep_until(bench.clock.now() + 2s);  // 4 turns/s roll out at 2 turns/s2
  CHECK(bench.is_at_rest());
}

TEST_CASE("an ODrive's error stops both wheels until a reset and a command of zero") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.left.set_lasting_error(0x1000);  // too much current
  bench.drive(2.0, 2.0, 15);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveFault);
  CHECK(bench.right.velocity() == 0.0);  // the other one brakes
  bench.drive(0.0, 0.0, 120);
  CHECK(bench.is_at_rest());
  bench.left.set_lasting_error(0);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());
  bench.base.reset();
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 30);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(4.0));
}

TEST_CASE("an ODrive whose error lasts stays stopped after a reset") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.left.set_lasting_error(0x1000);
  bench.drive(2.0, 2.0, 20);
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);  // it has a second to clear
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.drive(2.0, 2.0, 20);
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("ODrives that fall silent or restart or are stopped by a button of their own are noticed") {
  tests::OdriveBench unplugged;
  unplugged.bring_to_two_radps();
  unplugged.left.pull_cable();
  unplugged.drive(2.0, 2.0, 20);
  CHECK(unplugged.base.trouble() == DriveTrouble::kDriveSilent);
  CHECK(unplugged.right.velocity() == 0.0);

  tests::OdriveBench restarted;
  restarted.bring_to_two_radps();
  restarted.right.restart();
  restarted.drive(2.0, 2.0, 20);
  CHECK(restarted.base.trouble() == DriveTrouble::kDriveRestarted);
  CHECK(restarted.left.velocity() == 0.0);

  tests::OdriveBench stopped;
  stopped.bring_to_two_radps();
  stopped.left.raise_fault(odrive::kEstopRequested);  // a button at its own input
  stopped.drive(2.0, 2.0, 20);
  CHECK(stopped.base.trouble() == DriveTrouble::kEmergency);
}

TEST_CASE("a bus that refuses frames or is off stops ODrives") {
  tests::OdriveBench refused;
  refused.bring_to_two_radps();
  refused.bus.port(0).refuse_sends(1);
  refused.drive(2.0, 2.0, 15);
  CHECK(refused.base.trouble() == DriveTrouble::kBusRefused);
  CHECK(refused.is_at_rest());
  tests::OdriveBench off;
  off.bring_to_two_radps();
  off.bus.port(0).set_state(CanState::kBusOff);
  off.drive(2.0, 2.0, 5);
  CHECK(off.base.trouble() == DriveTrouble::kBusUnwell);
  CHECK_FALSE(off.left.is_enabled());
}

TEST_CASE("a command to ODrives that is no number turns no wheel") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.drive(std::numeric_limits<double>::quiet_NaN(), 2.0, 50);
  CHECK(bench.is_at_rest());
}

TEST_CASE("ODrives are disarmed at the end without that being trouble") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 20);
  for (int k = 0; k < 10 && bench.base.is_enabled(); ++k) {
    bench.base.disarm();
    bench.clock.sleep_until(bench.clock.now() + 20ms);
  }
  CHECK_FALSE(bench.base.is_enabled());
  CHECK(bench.base.latest().trouble == DriveTrouble::kNone);
}

TEST_CASE("ODrives that are disarmed while they drive are braked first") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  for (int k = 0; k < 60; ++k) {  // what is left below 0.5 rad/s rolls out
    static_cast<void>(bench.base.latest());
    bench.base.disarm();
    bench.clock.sleep_until(bench.clock.now() + 20ms);
  }
  CHECK(bench.is_at_rest());
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  static_cast<void>(bench.base.latest());
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("a second way tells ODrives to stand still") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  odrive::Stopper stopper(bench.bus.port(3), {3, 4});
  for (int k = 0; k < 10; ++k) {
    stopper.brake();
    bench.clock.sleep_until(bench.clock.now() + 25ms);
  }
  CHECK(bench.is_at_rest());
}

TEST_CASE("ODrive axes that cannot be are refused") {
  odrive::BaseSetup setup = tests::two_odrives();
  setup.axes[1].node = 3;
  CHECK_THROWS_AS(tests::OdriveBench(setup), StartupError);
  setup.axes[1].node = 63;
  CHECK_THROWS_AS(tests::OdriveBench(setup), StartupError);
  setup = tests::two_odrives();
  setup.axes[0].turns_per_rad = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(tests::OdriveBench(setup), StartupError);
}

TEST_CASE("whatever stands on the bus the state of wheels on ODrives stays finite and a stop stays a stop") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  tests::RandomBytes random(72);
  bool stopped = false;
  for (int k = 0; k < 2000; ++k) {
    for (int burst = 0; burst < 4; ++burst) {
      CanFrame any;
      any.id = static_cast<std::uint32_t>(0x60 + random.below(0x40));
      any.size = static_cast<std::uint8_t>(random.below(9));
      for (std::uint8_t at = 0; at < any.size; ++at) any.bytes[at] = random.byte();
      CHECK(bench.bus.port(3).send(any) == SendResult::kQueued);
    }
    bench.drive(2.0, 2.0, 1);
    REQUIRE(std::isfinite(bench.wheels.left_rad + bench.wheels.right_rad));
    REQUIRE(std::isfinite(bench.wheels.left_radps + bench.wheels.right_radps));
    REQUIRE((!stopped || bench.base.trouble() != DriveTrouble::kNone));
    stopped = bench.base.trouble() != DriveTrouble::kNone;
  }
  CHECK(stopped);
}
