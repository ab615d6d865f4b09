#include "drivers/canopen/drive_base.h"

#include <chrono>
#include <string>

#include "tests/drivers/drive_bench.h"
#include "tests/drivers/hand_clock.h"

using namespace jaywalk;
using namespace jaywalk::canopen;
using tests::two_axes;
using Bench = tests::Cia402Bench;
using namespace std::chrono_literals;

TEST_CASE("arming writes and reads back every setting of both drives") {
  Bench bench;
  CHECK(bench.armed() == "armed");
  // 12 settings, 7 + 8 + 6 writes for the three PDOs, standstill and 4 of identity, of two drives.
  REQUIRE(bench.report.size() == 76);
  CHECK(bench.report[0] == "node 5: 1016h:1 watches the controller's heartbeat: wanted 00010064h, reads the same");
  for (std::size_t k = 0; k < 33; ++k) CHECK(bench.report[k].ends_with(", reads the same"));
  CHECK(bench.report[33] == "node 5: 606Ch:0 stands: at most 0000012Ch, reads 00000000h");  // 0.3 rad/s
  CHECK(bench.report[37] == "node 5: 1018h:4 serial number, reads 00000007h");
  CHECK(bench.report[38].starts_with("node 6: 1016h:1 watches"));
  CHECK(bench.base.is_proved());
  CHECK(bench.right.objects().value({0x6007, 0}) == 3);
  CHECK(bench.right.objects().value({0x1800, 1}) == 0x186);
}

TEST_CASE("a drive that nobody told to watch drives on when the controller dies") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.objects().set({0x1016, 1}, 0);
  bench.clock.sleep_until(bench.clock.now() + 1s);
  CHECK(bench.left.velocity() == Approx(2000.0));
  CHECK(bench.right.velocity() == 0.0);
}

TEST_CASE("a drive that lies about its watchdog is not armed") {
  Bench bench;
  bench.right.objects().lie_about({0x1016, 1});
  CHECK(bench.armed() ==
        "node 6: 1016h:1 watches the controller's heartbeat: wanted 00010064h, reads 00000000h: NOT PROVED; "
        "use a drive that can prove it, or allow_unproved at your own risk");
  bench.drive(0.0, 0.0, 10);
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("an option that a drive keeps as it is proves it where it is the wanted one, and only there") {
  Bench bench;
  bench.left.objects().fix({0x605E, 0}, 2);
  CHECK(bench.armed() == "armed");
  REQUIRE(bench.report.size() == 76);
  Bench other;
  other.right.objects().fix({0x605E, 0}, 1);
  CHECK(other.armed().find("node 6: 605Eh:0 brakes at a fault: wanted 0002h, refused (read only): NOT PROVED") == 0);
}

TEST_CASE("looking at a drive tells what arming would meet and changes nothing") {
  Bench bench;
  bench.left.objects().lack({0x6007, 0});
  const auto refused = [&bench](std::size_t side) { return refusal_of([&] { return bench.base.inspect(side); }); };
  bench.right.objects().set({0x605A, 0}, 2);
  CHECK(bench.base.inspect(1) == "node 6: CiA 402, profile velocity; 1 of 12 settings stand as arming writes them");
  CHECK(refused(0).rfind("node 5: 6007h:0 stops when the controller is lost: wanted 0003h, refused (no such object)",
                         0) == 0);
  CHECK(bench.right.objects().value({0x1016, 1}) == 0);
  CHECK_FALSE(bench.right.is_enabled());
  bench.right.objects().set({0x6502, 0}, 1);  // profile position alone
  CHECK(refused(1).rfind("node 6: is no CiA 402 drive with profile velocity", 0) == 0);
  bench.right.pull_cable();
  CHECK(refused(1).rfind("node 6: no answer", 0) == 0);
}

TEST_CASE("a drive that does not answer is not armed") {
  Bench bench;
  bench.left.pull_cable();
  CHECK(bench.armed() ==
        "node 5: 1016h:1 watches the controller's heartbeat: wanted 00010064h, no answer: NOT PROVED; "
        "see to its cable, its power, its node number and the bus's bit rate");
}

TEST_CASE("one frame in fifty lost does not stop the drives") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.bus.set_faults({.loss = 0.02, .delay = 1ms});
  bench.drive(2.0, 2.0, 500);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK(bench.wheels.left_rad == Approx(bench.left.position() / 1000.0).margin(0.15));
}

TEST_CASE("wheel angles go on where a drive's position wraps") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  CanopenDriveBase base(bus.port(0), clock, two_axes());
  const auto say = [&](std::uint8_t low, std::uint8_t high) {
    const std::uint8_t mid = high == 0x7F ? 0xFF : 0x00;
    for (const std::uint32_t node : {5U, 6U}) {
      CHECK(bus.port(1).send(tests::frame(0x180 + node, {0x50, 0x02, 0, 0, 0, 0, 3})));
      CHECK(bus.port(1).send(tests::frame(0x280 + node, {low, mid, mid, high})));
    }
    return base.latest();
  };
  CHECK(say(0xF0, 0x7F).left_rad == 0.0);     // 7FFFFFF0h: where it happens to stand
  const WheelState wheels = say(0x10, 0x80);  // 80000010h: 32 counts further
  CHECK(wheels.left_rad == Approx(0.032));
  CHECK(wheels.right_rad == Approx(-0.032));
  CHECK(wheels.sequence == 2);
}
