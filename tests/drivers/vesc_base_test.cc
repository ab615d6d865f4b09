#include <chrono>
#include <limits>
#include <string>

#include "drivers/motor/vesc.h"
#include "drivers/wired_drive.h"
#include "tests/drivers/drive_bench.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::extended;
using tests::frame;
using Bench = tests::VescBench;

TEST_CASE("51 A to VESC 23 are the bytes that others measured") {
  CHECK(vesc::set_current(0x17, 51000) == extended(0x0117, {0x00, 0x00, 0xC7, 0x38}));
  CHECK(vesc::set_erpm(0x17, -3000) == extended(0x0317, {0xFF, 0xFF, 0xF4, 0x48}));  // 2^32 - 3000
  CHECK(vesc::set_brake_current(0x17, 1000) == extended(0x0217, {0x00, 0x00, 0x03, 0xE8}));
}

TEST_CASE("a VESC's status tells its speed") {
  // -3000 is FFFFF448h; current and duty cycle follow.
  const auto message = vesc::decode(extended(0x0904, {0xFF, 0xFF, 0xF4, 0x48, 0x00, 0xFF, 0xFE, 0x0C}));
  REQUIRE(message);
  CHECK(message->controller == 4);
  const auto* status = std::get_if<vesc::Status>(&message->content);
  REQUIRE(status != nullptr);
  CHECK(status->erpm == -3000);
}

TEST_CASE("a VESC's travel decodes to what others measured, and shorter messages are none") {
  const auto travel = vesc::decode(extended(0x1B04, {0x00, 0x00, 0x00, 0x0C, 0x00, 0xEF, 0x00, 0x00}));
  REQUIRE(travel);
  REQUIRE(std::holds_alternative<vesc::Travel>(travel->content));
  CHECK(std::get<vesc::Travel>(travel->content).sixths_of_electrical_turn == 12);
  CHECK_FALSE(vesc::decode(frame(0x104, {0, 0, 0, 0, 0, 0, 0, 0})));
  CHECK_FALSE(vesc::decode(extended(0x0904, {0, 0, 0, 0, 0, 0, 0})));
  CHECK_FALSE(vesc::decode(extended(0x1B04, {0, 0, 0, 0, 0})));
}

TEST_CASE("questions to a VESC are messages of type 8 that name who asks") {
  CHECK(vesc::ask_settings(0x17, 0xFE) == extended(0x0817, {0xFE, 0x00, 17}));
  CHECK(vesc::ask_fault(0x17, 0xFE) == extended(0x0817, {0xFE, 0x00, 50, 0x00, 0x00, 0x80, 0x00}));
}

TEST_CASE("the checksum of long VESC messages is the one that XMODEM has") {
  const std::string digits = "123456789";  // its well known check value
  CHECK(vesc::crc16({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}) == 0x31C3);
}

TEST_CASE("a VESC's settings are put together from pieces") {
  // 17, signature, number 23, 100 ms, 10 A (41200000h); its CRC by long division: see below.
  const std::array<std::uint8_t, 14> all{17, 1, 2, 3, 4, 23, 0, 0, 0, 100, 0x41, 0x20, 0, 0};
  const auto first = vesc::decode(extended(0x05FE, {0, 17, 1, 2, 3, 4, 23, 0}));
  const auto second = vesc::decode(extended(0x06FE, {0, 7, 0, 0, 100, 0x41, 0x20, 0}));
  const auto third = vesc::decode(extended(0x06FE, {0, 13, 0}));
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
  const auto told = vesc::decode(extended(0x08FE, {23, 1, 50, 0x00, 0x00, 0x80, 0x00, 3}));
  REQUIRE(told);
  REQUIRE(std::holds_alternative<vesc::Fault>(told->content));
  CHECK(std::get<vesc::Fault>(told->content).from == 23);
  CHECK(std::get<vesc::Fault>(told->content).code == 3);
  CHECK_FALSE(vesc::decode(extended(0x08FE, {23, 1, 51, 0x00, 0x00, 0x80, 0x00, 3})));
  CHECK_FALSE(vesc::decode(extended(0x08FE, {23, 1, 50, 0x00, 0x00, 0x80, 0x00})));
}

TEST_CASE("a VESC arms when its timeout and brake current were read back") {
  Bench bench;
  REQUIRE(bench.armed() == "armed");
  REQUIRE(bench.report.size() == 2);
  CHECK(bench.report[0] ==
        "VESC 23: timeout: wanted 40 to 90 ms, reads 90 ms, then brakes with 10.0 A; its minimum ERPM cannot be read: "
        "set it to 0 (VESC Tool, Motor Settings, PID Controllers)");
  CHECK(bench.report[1].starts_with("VESC 24: timeout: wanted 40 to 90 ms, reads 90 ms, then brakes with 10.0 A; "));
}

TEST_CASE("looking at a VESC reads its settings back and sends no speed") {
  Bench bench;
  CHECK(bench.base.inspect(0).starts_with(
      "VESC 23: timeout: wanted 40 to 90 ms, reads 90 ms, then brakes with 10.0 A; its minimum ERPM"));
  CHECK(bench.left.heard_controller() == kNever);
  bench.right.set_timeout(1000, 0.0F);
  CHECK_THROWS_AS(bench.base.inspect(1), StartupError);
}

TEST_CASE("a VESC without timeout or without brake or without a sound answer is not armed") {
  const auto refusal = tests::armed_after<Bench, void (*)(Bench&)>;
  CHECK(refusal([](Bench& bench) {
          bench.left.set_timeout(0, 10.0F);
        }).starts_with("VESC 23: timeout: wanted 40 to 90 ms, reads 0 ms, "));
  CHECK(refusal([](Bench& bench) {
          bench.left.set_timeout(30, 10.0F);
        }).starts_with("VESC 23: timeout: wanted 40 to 90 ms, reads 30 ms, "));
  CHECK(holds(refusal([](Bench& bench) { bench.left.set_timeout(90, 0.0F); }), "then brakes with 0.0 A: NOT PROVED"));
  CHECK(refusal([](Bench& bench) {
          bench.left.damage_answers();
        }).starts_with("VESC 23: timeout: answer damaged: NOT PROVED; "));
  CHECK(refusal([](Bench& bench) { bench.right.withhold_answers(); }) ==
        "VESC 24: timeout: no answer: NOT PROVED; see to its cable, its power and its controller number; firmware 3.0 "
        "and newer answers");
  CHECK(refusal([](Bench& bench) { bench.left.pull_cable(); }).starts_with("VESC 23: no status message 1; "));
  CHECK(refusal([](Bench& bench) { bench.left.withhold_travel(); }).starts_with("VESC 23: no status message 5; "));
}

TEST_CASE("a VESC that is told less than its minimum ERPM is named with that, and no more once it turns") {
  Bench bench;
  bench.left.set_minimum_erpm(900.0);  // 0.6 rad/s
  REQUIRE(bench.armed() == "armed");
  bench.drive(0.0, 0.0, 10);
  bench.drive(0.5, 0.5, 10);
  CHECK(bench.left.erpm() == 0.0);
  CHECK(bench.wheels.fault == DriveFault{DriveFaultKind::kVescStill, 23, 750});
  CHECK(describe(bench.wheels.fault) ==
        "VESC 23: told 750 ERPM, and its motor does not turn: blocked, or its minimum ERPM lies above; set that to 0 "
        "(VESC Tool, Motor Settings, PID Controllers)");
  bench.drive(2.0, 2.0, 20);
  CHECK_FALSE(bench.wheels.fault.is_told());
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
}

TEST_CASE("wheel angles go on where a VESC's travel wraps") {
  Bench bench;
  bench.left.set_travel(std::numeric_limits<std::int32_t>::max() - 100);
  bench.bring_to_two_radps();
  // 48 electrical turns and more are 285 sixths: beyond the wrap.
  CHECK(bench.wheels.left_rad == Approx(1.9).margin(0.06));
}

TEST_CASE("reading back does not show that a VESC keeps to what it tells") {
  Bench bench;
  bench.left.set_timeout(1000, 10.0F);
  bench.left.lie_about_timeout(90);
  bench.bring_to_two_radps();  // it is armed: why the report says read back and not shown
  bench.clock.sleep_until(bench.clock.now() + 500ms);
  CHECK(bench.left.erpm() == Approx(3000.0));
}

TEST_CASE("another master with our own number that asks a VESC is found by the answers") {
  Bench bench;
  bench.bring_to_two_radps();
  // Each of our questions is answered once; its questions are heard as well, but here its answers alone.
  for (int k = 0; k < 3; ++k) bench.stranger_says(extended(0x08FE, {24, 1, 50, 0, 0, 0x80, 0, 0}));
  bench.drive(2.0, 2.0, 1);
  CHECK(bench.base.trouble() == DriveTrouble::kForeignMaster);
}
