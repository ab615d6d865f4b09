#include "drivers/canopen/drive_base.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/can/in_process_bus.h"
#include "hal/types/errors.h"
#include "tests/drivers/drive_bench.h"
#include "tests/drivers/frames.h"
#include "tests/drivers/hand_clock.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::canopen;
using tests::two_axes;
using Bench = tests::DriveBench;
using namespace std::chrono_literals;

TEST_CASE("arming writes and reads back every setting of both drives") {
  Bench bench;
  CHECK(bench.refusal() == "armed");
  // 13 settings, 7 + 8 + 6 writes for the three PDOs, standstill and 4 of identity, of two drives.
  REQUIRE(bench.report.size() == 78);
  CHECK(bench.report[0] == "node 5: 1016h:1 watches the controller's heartbeat: wanted 00010064h, reads the same");
  for (std::size_t k = 0; k < 34; ++k) CHECK(bench.report[k].ends_with(", reads the same"));
  CHECK(bench.report[34] == "node 5: 606Ch:0 stands: at most 0000012Ch, reads 00000000h");  // 0.3 rad/s
  CHECK(bench.report[38] == "node 5: 1018h:4 serial number, reads 00000007h");
  CHECK(bench.report[39].starts_with("node 6: 1016h:1 watches"));
  CHECK(bench.base.is_proved());
  CHECK(bench.right.objects().value({0x6007, 0}) == 3);
  CHECK(bench.right.objects().value({0x1800, 1}) == 0x186);
}

TEST_CASE("wheels turn as commanded and are felt in the same direction") {
  Bench bench;
  bench.bring_to_two_radps();
  CHECK(bench.wheels.left_radps == Approx(2.0));
  CHECK(bench.wheels.right_radps == Approx(2.0));
  CHECK(bench.wheels.left_rad > 1.0);
  // 0.4 s of ramp are 0.4 rad, 0.6 s at 2 rad/s 1.2 more; a few milliseconds go between command and drive.
  CHECK(bench.left.position() / 1000.0 == Approx(1.6).margin(0.01));
  // What was felt was measured at the SYNC before the last: two ticks, 0.08 rad, and a count of rounding.
  CHECK(bench.wheels.left_rad == Approx(bench.left.position() / 1000.0).margin(0.09));
  CHECK(bench.wheels.right_rad == Approx(bench.right.position() / -1000.0).margin(0.09));
  CHECK(bench.wheels.sequence > 50);
  CHECK(bench.clock.now() - bench.wheels.stamp <= 40ms);
}

TEST_CASE("nothing moves before a command of zero") {
  Bench bench;
  bench.report = bench.base.arm();
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.base.is_enabled());
  bench.drive(0.0, 0.0, 10);
  CHECK(bench.base.is_enabled());
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(2000.0));
}

TEST_CASE("disarming takes the torque away, and only a command of zero brings it back") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  for (int k = 0; k < 5; ++k) {
    bench.wheels = bench.base.latest();
    bench.base.disarm();
    bench.clock.sleep_until(bench.clock.now() + 20ms);
  }
  CHECK_FALSE(bench.base.is_enabled());
  CHECK_FALSE(bench.left.is_enabled());
  CHECK(bench.wheels.trouble == DriveTrouble::kNone);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());
}

TEST_CASE("drives stop by themselves when the controller dies") {
  Bench bench;
  bench.bring_to_two_radps();
  // Its last heartbeat was 20 ms ago. The drives miss it 100 ms after it was sent; 2000 counts/s at 20000 counts/s2
  // take 100 ms more; two steps of 1 ms for what falls between them.
  bench.clock.sleep_until(bench.clock.now() + 182ms);
  CHECK(bench.is_at_rest());
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
  CHECK(bench.refusal() ==
        "node 6: 1016h:1 watches the controller's heartbeat: wanted 00010064h, reads 00000000h: NOT PROVED; "
        "use a drive that can prove it, or allow_unproved at your own risk");
  bench.drive(0.0, 0.0, 10);
  CHECK_FALSE(bench.base.is_enabled());
}

TEST_CASE("a drive without the abort connection option arms only when that is allowed and it is on record") {
  Bench strict;
  strict.left.objects().lack({0x6007, 0});
  CHECK(strict.refusal().starts_with(
      "node 5: 6007h:0 stops when the controller is lost: wanted 0003h, refused (no such object): NOT PROVED; "));
  DriveBaseSetup setup = two_axes();
  setup.allow_unproved = true;
  Bench lax(setup);
  lax.left.objects().lack({0x6007, 0});
  CHECK(lax.refusal() == "armed");
  REQUIRE(lax.report.size() == 78);
  CHECK(lax.report[2].ends_with("refused (no such object): NOT PROVED"));
}

TEST_CASE("an option that a drive keeps as it is proves it where it is the wanted one, and only there") {
  Bench bench;
  bench.left.objects().fix({0x605E, 0}, 2);
  CHECK(bench.refusal() == "armed");
  REQUIRE(bench.report.size() == 78);
  Bench other;
  other.right.objects().fix({0x605E, 0}, 1);
  CHECK(other.refusal().find("node 6: 605Eh:0 brakes at a fault: wanted 0002h, refused (read only): NOT PROVED") == 0);
}

TEST_CASE("looking at a drive tells what arming would meet and changes nothing") {
  Bench bench;
  bench.left.objects().lack({0x6007, 0});
  const auto told = [&bench](std::size_t side) -> std::string {
    try {
      return bench.base.inspect(side);
    } catch (const StartupError& error) {
      return error.what();
    }
  };
  bench.right.objects().set({0x605A, 0}, 2);
  CHECK(told(1) == "node 6: CiA 402, profile velocity; 1 of 13 settings stand as arming writes them");
  CHECK(told(0).rfind("node 5: 6007h:0 stops when the controller is lost: wanted 0003h, refused (no such object)", 0) ==
        0);
  CHECK(bench.right.objects().value({0x1016, 1}) == 0);
  CHECK_FALSE(bench.right.is_enabled());
  bench.right.objects().set({0x6502, 0}, 1);  // profile position alone
  CHECK(told(1).rfind("node 6: is no CiA 402 drive with profile velocity", 0) == 0);
  bench.right.pull_cable();
  CHECK(told(1).rfind("node 6: no answer", 0) == 0);
}

TEST_CASE("a drive that does not answer is not armed") {
  Bench bench;
  bench.left.pull_cable();
  CHECK(bench.refusal().starts_with(
      "node 5: 1016h:1 watches the controller's heartbeat: wanted 00010064h, no answer: NOT PROVED; "));
}

TEST_CASE("a fault of one drive stops both until a reset and a command of zero") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.raise_fault(0x2310);
  bench.drive(2.0, 2.0, 8);  // 100 ms of ramp, a tick to hear it and one to say it
  CHECK(bench.base.trouble() == DriveTrouble::kEmergency);
  CHECK(bench.wheels.trouble == DriveTrouble::kEmergency);  // the loop reads it there
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 20);  // zero alone does not do
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.is_at_rest());
  bench.base.reset();
  bench.drive(2.0, 2.0, 150);  // nor does a reset alone, and the proof that it begins
  CHECK(bench.base.is_proved());
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 20);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.left.velocity() == Approx(2000.0));
  CHECK(bench.right.velocity() == Approx(-2000.0));
}

TEST_CASE("a drive whose cable is pulled is missed and the other stopped") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.pull_cable();
  bench.drive(2.0, 2.0, 16);  // 150 ms until it is missed, 100 ms of ramp, and ticks
  CHECK(bench.base.trouble() == DriveTrouble::kDriveSilent);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a controller that is bus-off says so and the drives stop by themselves") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.bus.port(0).set_state(CanState::kBusOff);
  bench.drive(2.0, 2.0, 12);
  CHECK(bench.base.trouble() == DriveTrouble::kBusUnwell);
  CHECK(name(bench.base.trouble()) == "bus unwell");
  CHECK(bench.is_at_rest());
}

TEST_CASE("a bus that takes no frames stops the drives") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.bus.port(0).refuse_sends(4);
  bench.drive(2.0, 2.0, 12);
  CHECK(bench.base.trouble() == DriveTrouble::kBusRefused);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a command that is no number turns no wheel") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.drive(std::numeric_limits<double>::quiet_NaN(), 2.0, 50);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a thousand ticks ask nothing of the heap and lose no frame") {
  Bench bench;
  bench.bring_to_two_radps();
  const AllocationGuard guard;
  bench.drive(1.0, 1.5, 1000);
  const auto calls = guard.calls();
  CHECK(calls == 0);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK(bench.bus.port(0).health().frames_lost == 0);
  CHECK(bench.right.velocity() == Approx(-1500.0));
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
      CHECK(bus.port(1).send(tests::frame(0x180 + node, {0x50, 0x02, 0, 0, 0, 0, 3})) == SendResult::kQueued);
      CHECK(bus.port(1).send(tests::frame(0x280 + node, {low, mid, mid, high})) == SendResult::kQueued);
    }
    return base.latest();
  };
  CHECK(say(0xF0, 0x7F).left_rad == 0.0);     // 7FFFFFF0h: where it happens to stand
  const WheelState wheels = say(0x10, 0x80);  // 80000010h: 32 counts further
  CHECK(wheels.left_rad == Approx(0.032));
  CHECK(wheels.right_rad == Approx(-0.032));
  CHECK(wheels.sequence == 2);
}

TEST_CASE("axes that cannot be are refused") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  DriveBaseSetup setup = two_axes();
  setup.axes[1].node = 5;
  CHECK_THROWS_AS(CanopenDriveBase(bus.port(0), clock, setup), StartupError);
  setup.axes[1].node = 1;  // the controller's own
  CHECK_THROWS_AS(CanopenDriveBase(bus.port(0), clock, setup), StartupError);
  setup = two_axes();
  setup.axes[0].counts_per_rad = 0.0;
  CHECK_THROWS_AS(CanopenDriveBase(bus.port(0), clock, setup), StartupError);
}

TEST_CASE("whatever stands on the bus the wheels' state stays finite and a stop stays a stop") {
  Bench bench;
  bench.bring_to_two_radps();
  tests::RandomBytes random(71);
  constexpr std::array<std::uint32_t, 8> kIds{0x000, 0x085, 0x185, 0x285, 0x585, 0x605, 0x705, 0x706};
  bool stopped = false;
  for (int k = 0; k < 3000; ++k) {
    for (int burst = 0; burst < 4; ++burst) {
      CanFrame any;
      any.id = random.below(4) == 0 ? static_cast<std::uint32_t>(random.below(0x800)) : kIds[random.below(kIds.size())];
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
