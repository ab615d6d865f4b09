#include <chrono>
#include <string>

#include "drivers/motor/odrive.h"
#include "tests/drivers/drive_bench.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::extended;
using tests::frame;
using Bench = tests::OdriveBench;

TEST_CASE("ODrive commands of node 3 begin at 060h") {
  CHECK(odrive::set_axis_state(3, odrive::kClosedLoop) == frame(0x067, {8, 0, 0, 0}));
  CHECK(odrive::set_velocity_mode(3, true) == frame(0x06B, {2, 0, 0, 0, 2, 0, 0, 0}));
  CHECK(odrive::set_velocity_mode(3, false) == frame(0x06B, {2, 0, 0, 0, 1, 0, 0, 0}));
  // -2.5 is C0200000h: sign, 2^1, 1.25.
  CHECK(odrive::set_velocity(3, -2.5F) == frame(0x06D, {0x00, 0x00, 0x20, 0xC0, 0, 0, 0, 0}));
  CHECK(odrive::emergency_stop(3) == frame(0x062, {}));
  CHECK(odrive::clear_errors(3) == frame(0x078, {0}));
}

TEST_CASE("an ODrive heartbeat shows the watchdog error and the state") {
  const auto message = odrive::decode(frame(0x061, {0x00, 0x00, 0x00, 0x01, 1, 0, 0, 0}));
  REQUIRE(message);
  CHECK(message->node == 3);
  const auto* heartbeat = std::get_if<odrive::Heartbeat>(&message->content);
  REQUIRE(heartbeat != nullptr);
  CHECK((heartbeat->active_errors & odrive::kWatchdogExpired) != 0);
  CHECK(heartbeat->axis_state == 1);
  CHECK_FALSE(odrive::decode(frame(0x061, {0, 0, 0, 1})));
}

TEST_CASE("ODrive estimates are turns and turns a second and must be finite") {
  // 1.5 is 3FC00000h, -0.25 is BE800000h.
  const auto message = odrive::decode(frame(0x069, {0, 0, 0xC0, 0x3F, 0, 0, 0x80, 0xBE}));
  REQUIRE(message);
  const auto* estimates = std::get_if<odrive::EncoderEstimates>(&message->content);
  REQUIRE(estimates != nullptr);
  CHECK(estimates->position_turns == 1.5F);
  CHECK(estimates->velocity_turns_per_s == -0.25F);
  CHECK_FALSE(odrive::decode(frame(0x069, {0, 0, 0xC0, 0x7F, 0, 0, 0x80, 0xBE})));  // not a number
  CHECK_FALSE(odrive::decode(extended(0x069, {0, 0, 0xC0, 0x3F, 0, 0, 0x80, 0xBE})));
}

TEST_CASE("an ODrive arms when its watchdog was seen to let go by itself") {
  Bench bench;
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
  Bench bench;
  CHECK(bench.base.inspect(1).starts_with("ODrive node 4: heartbeat and encoder estimates; errors 00000000h;"));
  CHECK_FALSE(bench.right.is_enabled());
  bench.left.pull_cable();
  bench.drive(0.0, 0.0, 1);
  CHECK_THROWS_AS(bench.base.inspect(0), StartupError);
}

TEST_CASE("an ODrive that says its watchdog expired and holds on is not armed") {
  Bench bench;
  bench.left.lie_about_watchdog();
  CHECK(bench.armed().find("and holds on: NOT PROVED") != std::string::npos);
  bench.clock.sleep_until(bench.clock.now() + 2ms);
  CHECK_FALSE(bench.left.is_enabled());  // it was told to let go
}

TEST_CASE("an ODrive of firmware 0.5 is not armed, and told that its firmware is too old") {
  Bench bench;
  bench.left.be_of_firmware_05();
  const std::string said = bench.armed();
  CHECK(said.starts_with("ODrive node 3: watchdog: expired "));
  CHECK(said.find("with error 00000800h, as firmware 0.5 says it: its firmware is too old, 0.6 is wanted") !=
        std::string::npos);
  CHECK_FALSE(bench.left.is_enabled());
}

TEST_CASE("an ODrive whose watchdog is slow or hasty is not armed") {
  const auto refusal = tests::armed_after<Bench, void (*)(Bench&)>;
  CHECK(refusal([](Bench& bench) {
          bench.left.set_watchdog(150ms);
        }).starts_with("ODrive node 3: watchdog: nothing said 100 ms"));
  CHECK(holds(refusal([](Bench& bench) { bench.left.set_watchdog(15ms); }),
              "after the last command, too soon for two commands: NOT PROVED"));
}

TEST_CASE("an ODrive that is not there, tells too little, is broken or does not go to closed loop is not armed") {
  const auto refusal = tests::armed_after<Bench, void (*)(Bench&)>;
  CHECK(refusal([](Bench& bench) { bench.right.pull_cable(); }) ==
        "ODrive node 4: no heartbeat; see that the bus is up and the drive is powered");
  CHECK(refusal([](Bench& bench) {
          bench.left.withhold_estimates();
        }).starts_with("ODrive node 3: no encoder estimates; "));
  CHECK(refusal([](Bench& bench) {
          bench.left.set_lasting_error(0x200);
        }).starts_with("ODrive node 3: errors 00000200h (DC bus under-voltage) that do not clear: NOT PROVED; see to"));
  CHECK(refusal([](Bench& bench) { bench.right.refuse_closed_loop(11); }) ==
        "ODrive node 4: does not go to closed loop, errors 00000000h, procedure result 11 (timeout): NOT PROVED; see "
        "to what it names, and calibrate it anew, with odrivetool");
}

TEST_CASE("an ODrive whose cable is pulled in its proof is a matter of cable and power") {
  Bench bench;
  bench.clock.meanwhile = [&bench] {
    if (bench.left.is_enabled()) bench.left.pull_cable();
  };
  CHECK(bench.armed() == "ODrive node 3: no heartbeat any more: NOT PROVED; see to its cable, its power and its node");
}

TEST_CASE("an ODrive whose error lasts stays stopped after a reset") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.set_lasting_error(0x1000);
  bench.drive(2.0, 2.0, 20);
  bench.base.reset();
  bench.drive(0.0, 0.0, 60);  // it has a second to clear
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.drive(2.0, 2.0, 20);
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("a button at an ODrive's own input is an emergency stop") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.raise_fault(odrive::kEstopRequested);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.base.trouble() == DriveTrouble::kEmergency);
}

TEST_CASE("ODrives are proved whole after a power cut and then both wheels obey") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.left.pull_cable();
  bench.drive(0.0, 0.0, 25);
  bench.left.restart();
  bench.left.plug_cable();
  bench.drive(0.0, 0.0, 10);
  bench.base.reset();
  bool left_held = false, right_held = false;
  for (int k = 0; k < 60 && !bench.base.is_proved(); ++k) {
    bench.drive(2.0, 2.0, 1);
    left_held = left_held || bench.left.is_enabled();
    right_held = right_held || bench.right.is_enabled();
    REQUIRE(bench.is_at_rest());
  }
  CHECK((bench.base.is_proved() && left_held && right_held));
}

TEST_CASE("an ODrive that turns when it is held in its proof is let go") {
  Bench bench;
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

TEST_CASE("what restarts between arming and the first command is proved again by itself") {
  Bench bench;
  REQUIRE(bench.armed() == "armed");
  bench.left.pull_cable();
  bench.wait(200ms);
  bench.left.restart();
  bench.left.plug_cable();
  bench.drive(0.0, 0.0, 1);
  CHECK_FALSE(bench.base.is_proved());
  bench.drive(0.0, 0.0, 60);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(4.0));
}

TEST_CASE("an ODrive that hears another master names its frame") {
  Bench bench;
  bench.stranger_says(frame(0x06D, {0, 0, 0x80, 0x3F, 0, 0, 0, 0}));
  CHECK(bench.armed() ==
        "CAN: another program commands the drives: frame 06Dh 00 00 80 3F 00 00 00 00; end that program, or take it "
        "off this bus; a frame of a drive's own came too often: give each a number of its own, and an ODrive "
        "can.heartbeat_msg_rate_ms of 10 or more");
}
