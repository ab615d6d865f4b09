#include "drivers/motor/vesc_base.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "tests/drivers/frames.h"
#include "tests/drivers/random_bytes.h"
#include "tests/drivers/vesc_bench.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

CanFrame extended(CanFrame made) {
  made.extended = true;
  return made;
}

}  // namespace

TEST_CASE("questions to a VESC are messages of type 8 that name who asks") {
  CHECK(vesc::ask_settings(0x17, 0xFE) == extended(tests::frame(0x0817, {0xFE, 0x00, 17})));
  CHECK(vesc::ask_fault(0x17, 0xFE) == extended(tests::frame(0x0817, {0xFE, 0x00, 50, 0x00, 0x00, 0x80, 0x00})));
}

TEST_CASE("the checksum of long VESC messages is the one that XMODEM has") {
  const std::string digits = "123456789";  // its well known check value
  CHECK(vesc::crc16({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}) == 0x31C3);
}

TEST_CASE("a VESC's settings are put together from pieces") {
  // 17, signature, number 23, 100 ms, 10 A (41200000h); its CRC by long division: see below.
  const std::array<std::uint8_t, 14> all{17, 1, 2, 3, 4, 23, 0, 0, 0, 100, 0x41, 0x20, 0, 0};
  const auto first = vesc::decode(extended(tests::frame(0x05FE, {0, 17, 1, 2, 3, 4, 23, 0})));
  const auto second = vesc::decode(extended(tests::frame(0x06FE, {0, 7, 0, 0, 100, 0x41, 0x20, 0})));
  const auto third = vesc::decode(extended(tests::frame(0x06FE, {0, 13, 0})));
  REQUIRE((first && second && third));
  CHECK(first->controller == 0xFE);
  vesc::SettingsReader reader;
  vesc::PiecesEnd end{.from = 23, .size = 14, .crc = vesc::crc16(all)};
  reader.take(std::get<vesc::Piece>(first->content));
  reader.take(std::get<vesc::Piece>(second->content));
  CHECK_FALSE(reader.finish(end));  // one is missing
  reader.take(std::get<vesc::Piece>(third->content));
  const auto settings = reader.finish(end);
  REQUIRE(settings);
  CHECK(settings->timeout_ms == 100);
  CHECK(settings->brake_current_a == 10.0);
  end.crc ^= 1U;
  CHECK_FALSE(reader.finish(end));
}

TEST_CASE("a VESC's fault code is told by the answer to a question") {
  const auto told = vesc::decode(extended(tests::frame(0x08FE, {23, 1, 50, 0x00, 0x00, 0x80, 0x00, 3})));
  REQUIRE(told);
  REQUIRE(std::holds_alternative<vesc::Fault>(told->content));
  CHECK(std::get<vesc::Fault>(told->content).from == 23);
  CHECK(std::get<vesc::Fault>(told->content).code == 3);
  CHECK_FALSE(vesc::decode(extended(tests::frame(0x08FE, {23, 1, 51, 0x00, 0x00, 0x80, 0x00, 3}))));
  CHECK_FALSE(vesc::decode(extended(tests::frame(0x08FE, {23, 1, 50, 0x00, 0x00, 0x80, 0x00}))));
}

TEST_CASE("a VESC arms when its timeout and brake current were read back") {
  tests::VescBench bench;
  REQUIRE(bench.armed() == "armed");
  REQUIRE(bench.report.size() == 2);
  CHECK(bench.report[0] == "VESC 23: timeout: wanted 40 to 90 ms, reads 90 ms, then brakes with 10.0 A");
  CHECK(bench.report[1] == "VESC 24: timeout: wanted 40 to 90 ms, reads 90 ms, then brakes with 10.0 A");
}

TEST_CASE("looking at a VESC reads its settings back and sends no speed") {
  tests::VescBench bench;
  CHECK(bench.base.inspect(0) == "VESC 23: timeout: wanted 40 to 90 ms, reads 90 ms, then brakes with 10.0 A");
  CHECK(bench.left.heard_controller() == kNever);
  bench.right.set_timeout(1000, 0.0F);
  CHECK_THROWS_AS(bench.base.inspect(1), StartupError);
}

TEST_CASE("a VESC as it comes from the factory is not armed") {
  tests::VescBench bench;
  bench.right.set_timeout(1000, 0.0F);
  CHECK(bench.armed() ==
        "VESC 24: timeout: wanted 40 to 90 ms, reads 1000 ms, then brakes with 0.0 A: NOT PROVED; set timeout and "
        "timeout brake current (App Settings, General) with VESC Tool, or allow_unproved at your own risk");
  bench.drive(0.0, 0.0, 10);
  bench.drive(2.0, 2.0, 10);
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("a VESC without timeout or without brake or without a sound answer is not armed") {
  tests::VescBench never;
  never.left.set_timeout(0, 10.0F);
  CHECK(never.armed().starts_with("VESC 23: timeout: wanted 40 to 90 ms, reads 0 ms, "));
  tests::VescBench hasty;
  hasty.left.set_timeout(30, 10.0F);
  CHECK(hasty.armed().starts_with("VESC 23: timeout: wanted 40 to 90 ms, reads 30 ms, "));
  tests::VescBench rolls;
  rolls.left.set_timeout(90, 0.0F);
  CHECK(rolls.armed().find("then brakes with 0.0 A: NOT PROVED") != std::string::npos);
  tests::VescBench damaged;
  damaged.left.damage_answers();
  CHECK(damaged.armed().starts_with("VESC 23: timeout: answer damaged: NOT PROVED; "));
  tests::VescBench silent;
  silent.right.withhold_answers();
  CHECK(silent.armed().starts_with("VESC 24: timeout: no answer: NOT PROVED; "));
  tests::VescBench unplugged;
  unplugged.left.pull_cable();
  CHECK(unplugged.armed().starts_with("VESC 23: no status message 1; "));
  tests::VescBench blind;
  blind.left.withhold_travel();
  CHECK(blind.armed().starts_with("VESC 23: no status message 5; "));
}

TEST_CASE("an unproved VESC arms where that is allowed and it is on record") {
  vesc::BaseSetup setup = tests::two_vescs();
  setup.allow_unproved = true;
  tests::VescBench bench(setup);
  bench.left.set_timeout(1000, 0.0F);
  CHECK(bench.armed() == "armed");
  CHECK(bench.report[0].ends_with(": NOT PROVED"));
}

TEST_CASE("wheels on VESCs turn as commanded and are felt in the same direction") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  CHECK(bench.wheels.left_radps == Approx(2.0));
  CHECK(bench.wheels.right_radps == Approx(2.0));
  // 0.1 s of ramp are 0.1 rad, 0.9 s more at 2 rad/s 1.8; a tick late.
  CHECK(bench.wheels.left_rad == Approx(1.9).margin(0.06));
  CHECK(bench.wheels.right_rad == Approx(bench.wheels.left_rad).margin(0.02));
  CHECK(bench.wheels.sequence > 50);
  CHECK(bench.clock.now() - bench.wheels.stamp <= 30ms);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("wheel angles go on where a VESC's travel wraps") {
  tests::VescBench bench;
  bench.left.set_travel(std::numeric_limits<std::int32_t>::max() - 100);
  bench.bring_to_two_radps();
  // 48 electrical turns and more are 285 sixths: beyond the wrap.
  CHECK(bench.wheels.left_rad == Approx(1.9).margin(0.06));
}

TEST_CASE("nothing with VESCs moves before a command of zero") {
  tests::VescBench bench;
  REQUIRE(bench.armed() == "armed");
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 5);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.erpm() == Approx(3000.0));
}

TEST_CASE("VESCs brake by themselves when the controller dies") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  // The last command was 20 ms ago; 90 ms of timeout, 100 ms of ramp, two steps.
  bench.clock.sleep_until(bench.clock.now() + 172ms);
  CHECK(bench.is_at_rest());
}

TEST_CASE("reading back does not show that a VESC keeps to what it tells") {
  tests::VescBench bench;
  bench.left.set_timeout(1000, 10.0F);
  bench.left.lie_about_timeout(90);
  bench.bring_to_two_radps();  // it is armed: why the report says read back and not shown
  bench.clock.sleep_until(bench.clock.now() + 500ms);
  CHECK(bench.left.erpm() == Approx(3000.0));
}

TEST_CASE("a VESC's fault stops both wheels until a reset and a command of zero") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  bench.left.set_fault(3);
  bench.drive(2.0, 2.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveFault);
  CHECK(bench.right.erpm() == 0.0);
  bench.left.set_fault(0);
  bench.drive(0.0, 0.0, 20);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());
  bench.base.reset();
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 20);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK(bench.left.erpm() == Approx(3000.0));
}

TEST_CASE("a VESC that falls silent and a bus that fails are noticed") {
  tests::VescBench unplugged;
  unplugged.bring_to_two_radps();
  unplugged.left.pull_cable();
  unplugged.drive(2.0, 2.0, 20);
  CHECK(unplugged.base.trouble() == DriveTrouble::kDriveSilent);
  CHECK(unplugged.is_at_rest());
  tests::VescBench refused;
  refused.bring_to_two_radps();
  refused.bus.port(0).refuse_sends(1);
  refused.drive(2.0, 2.0, 10);
  CHECK(refused.base.trouble() == DriveTrouble::kBusRefused);
  CHECK(refused.is_at_rest());
}

TEST_CASE("VESCs are disarmed at the end without that being trouble") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 20);
  bench.base.disarm();
  CHECK_FALSE(bench.base.is_enabled());
  bench.clock.sleep_until(bench.clock.now() + 40ms);
  CHECK(bench.base.latest().trouble == DriveTrouble::kNone);
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("VESCs that are disarmed while they drive are braked first") {
  tests::VescBench bench;
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

TEST_CASE("a second way tells VESCs to stand still") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  vesc::Stopper stopper(bench.bus.port(3), {23, 24});
  for (int k = 0; k < 6; ++k) {
    stopper.brake();
    bench.clock.sleep_until(bench.clock.now() + 25ms);
  }
  CHECK(bench.is_at_rest());
}

TEST_CASE("VESCs that cannot be are refused") {
  vesc::BaseSetup setup = tests::two_vescs();
  setup.axes[1].controller = 23;
  CHECK_THROWS_AS(tests::VescBench(setup), StartupError);
  setup.axes[1].controller = 254;
  CHECK_THROWS_AS(tests::VescBench(setup), StartupError);
  setup = tests::two_vescs();
  setup.axes[0].electrical_turns_per_rad = 0.0;
  CHECK_THROWS_AS(tests::VescBench(setup), StartupError);
}

TEST_CASE("whatever stands on the bus the state of wheels on VESCs stays finite and a stop stays a stop") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  tests::RandomBytes random(73);
  bool stopped = false;
  constexpr std::array<std::uint32_t, 4> kWhom{23, 24, 254, 0};
  for (int k = 0; k < 2000; ++k) {
    for (int burst = 0; burst < 4; ++burst) {
      CanFrame any;
      any.extended = true;
      any.id = static_cast<std::uint32_t>(random.below(32)) << 8U | kWhom[random.below(kWhom.size())];
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
}
