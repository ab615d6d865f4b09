// What may keep a CiA 402 drive from obeying a stop, one after the other: in each case both wheels stand within 100 ms
// and the ramp, or the controller sends nothing any more within that time and the drives' own watchdogs stop them.
#include <chrono>
#include <functional>

#include "tests/drivers/drive_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::frame;
using Bench = tests::DriveBench;

namespace {

/// 2 rad/s at the 10/3 rad/s2 that the setup calls a ramp.
constexpr Duration kRamp = 600ms, kLimit = 100ms + kRamp;
const CanFrame kPreOperationalLeft = frame(0x000, {0x80, 5}), kPreOperationalAll = frame(0x000, {0x80, 0}),
               kStopAll = frame(0x000, {0x02, 0}), kResetLeft = frame(0x000, {0x81, 5}),
               kResetCommunicationLeft = frame(0x000, {0x82, 5});

/// Goes on wanting `wanted` of both wheels for the limit, `meanwhile` in every tick.
void check_stops(Bench& bench, double wanted, const std::function<void()>& meanwhile = {}) {
  const Time cause = bench.clock.now();
  Time stood = kNever;
  while (bench.clock.now() < cause + kLimit + 400ms) {
    if (meanwhile) meanwhile();
    bench.drive(wanted, wanted, 1);
    if (bench.is_at_rest() && stood == kNever) stood = bench.clock.now();
  }
  const bool stands = stood != kNever && stood - cause <= kLimit;
  const bool is_silent = bench.port.last() - cause <= kLimit;
  CHECK((stands || is_silent));
  // Where it is silent the drives miss the heartbeat after 100 ms and brake.
  CHECK(bench.is_at_rest());
  CHECK(bench.base.trouble() != DriveTrouble::kNone);
  CHECK(bench.wheels.trouble == bench.base.trouble());
}

/// The same with the stranger's NMT commands heard by the controller and not: what the drives show is to be enough.
void with_and_without_hearing(const std::function<void(Bench&)>& drill) {
  for (const bool hears : {true, false}) {
    Bench bench;
    if (!hears) bench.port.become_deaf_to(0x000);
    bench.bring_to_two_radps();
    drill(bench);
  }
}

}  // namespace

TEST_CASE("a drive that another program takes out of operation stops, and so does the other wheel") {
  with_and_without_hearing([](Bench& bench) {
    bench.stranger_says(kPreOperationalLeft);
    check_stops(bench, 2.0);
  });
}

TEST_CASE("both drives taken out of operation at once stop") {
  with_and_without_hearing([](Bench& bench) {
    bench.stranger_says(kPreOperationalAll);
    check_stops(bench, 2.0);
  });
}

TEST_CASE("drives that are NMT-stopped again and again stop by their own watchdogs") {
  with_and_without_hearing([](Bench& bench) {
    Time next = bench.clock.now();
    check_stops(bench, 2.0, [&] {
      if (bench.clock.now() < next) return;
      bench.stranger_says(kStopAll);
      next = bench.clock.now() + 50ms;
    });
    CHECK(bench.wheels.stop == StopStage::kSilent);
  });
}

TEST_CASE("a drive that is reset under way stops both wheels, or the controller falls silent") {
  with_and_without_hearing([](Bench& bench) {
    bench.stranger_says(kResetLeft);
    const Time cause = bench.clock.now();
    bench.drive(2.0, 2.0, 35);
    CHECK(bench.right.velocity() == 0.0);
    CHECK(bench.port.last() - cause <= kLimit);  // the left one has no torque and rolls out
    CHECK_FALSE(bench.left.is_enabled());
    CHECK(bench.wheels.stop == StopStage::kSilent);
  });
}

TEST_CASE("a drive whose communication is reset, which makes it forget whom it watches, stops") {
  with_and_without_hearing([](Bench& bench) {
    bench.stranger_says(kResetCommunicationLeft);
    check_stops(bench, 2.0);
  });
}

TEST_CASE("a drive that ignores a commanded stop is quick-stopped, and then its watchdog stops it") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.hang();
  check_stops(bench, 0.0);
  CHECK(bench.base.trouble() == DriveTrouble::kStopUnconfirmed);
  CHECK(bench.wheels.stop == StopStage::kSilent);
}

TEST_CASE("a drive that ignores the quick stop because of the other's fault is stopped by its watchdog") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.hang();
  bench.right.raise_fault(0x2310);
  check_stops(bench, 2.0);
  CHECK(bench.base.trouble() == DriveTrouble::kEmergency);
}

TEST_CASE("a wheel whose feedback is lost under way stops both") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.right.lose_feedback();
  check_stops(bench, 2.0);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveSilent);
}

TEST_CASE("once silent the controller sends nothing at all until a reset") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.right.lose_feedback();
  bench.drive(2.0, 2.0, 20);
  REQUIRE(bench.wheels.stop == StopStage::kSilent);
  const auto sent = bench.port.sent();
  bench.drive(2.0, 2.0, 50);
  bench.drive(0.0, 0.0, 50);
  for (int k = 0; k < 20; ++k) bench.base.disarm();
  CHECK(bench.port.sent() == sent);
}

TEST_CASE("a drive that has left the network state is quick-stopped by SDO before its watchdog acts") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.objects().set({0x1016, 1}, 0);  // it watches nobody any more
  bench.stranger_says(kPreOperationalLeft);
  bench.drive(2.0, 2.0, 12);
  CHECK(bench.is_at_rest());
}

TEST_CASE("ordinary stops from any speed and disarming are confirmed and trouble nobody") {
  Bench bench;
  bench.report = bench.base.arm();
  bench.drive(0.0, 0.0, 10);
  for (const double speed : {0.2, 1.0, 2.0, -2.0, 0.5}) {
    bench.drive(speed, speed, 30);
    bench.drive(speed, -speed, 30);
    bench.drive(0.0, 0.0, 30);
    REQUIRE(bench.base.trouble() == DriveTrouble::kNone);
    REQUIRE(bench.wheels.stop == StopStage::kNone);
  }
  bench.drive(2.0, 2.0, 30);
  for (int k = 0; k < 30; ++k) {  // still on the move: it brakes first
    bench.wheels = bench.base.latest();
    bench.base.disarm();
    bench.clock.sleep_until(bench.clock.now() + 20ms);
  }
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.left.is_enabled());
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
}

TEST_CASE("at 20 Hz, too, a drive that ignores a stop is told nothing more 100 ms after the ramp") {
  for (const double speed : {0.35, 0.7, 2.0}) {
    CAPTURE(speed);
    canopen::DriveBaseSetup setup = tests::two_axes();
    setup.stop = stop_limits(setup.stop.brake_radps2, setup.stop.tolerance_radps, 50ms);
    Bench bench(setup);
    bench.tick = 50ms;
    bench.report = bench.base.arm();
    bench.drive(0.0, 0.0, 10);
    bench.drive(speed, speed, 40);
    bench.left.hang();
    const Time order = bench.clock.now();
    bench.drive(0.0, 0.0, 40);
    CHECK(bench.wheels.stop == StopStage::kSilent);
    CHECK(bench.port.last() - order <= duration_from_seconds(speed / setup.stop.brake_radps2) + 100ms);
    CHECK(bench.is_at_rest());
  }
}

TEST_CASE("at 20 Hz ordinary stops are confirmed and trouble nobody") {
  canopen::DriveBaseSetup setup = tests::two_axes();
  setup.stop = stop_limits(setup.stop.brake_radps2, setup.stop.tolerance_radps, 50ms);
  Bench bench(setup);
  bench.tick = 50ms;
  bench.report = bench.base.arm();
  bench.drive(0.0, 0.0, 10);
  for (const double speed : {0.2, 0.4, 1.0, 2.0, -2.0, 0.5}) {
    bench.drive(speed, -speed, 20);
    bench.drive(0.0, 0.0, 20);
    REQUIRE(bench.base.trouble() == DriveTrouble::kNone);
    REQUIRE(bench.wheels.stop == StopStage::kNone);
  }
}
