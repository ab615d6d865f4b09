// What may keep a CiA 402 drive from obeying a stop, one after the other: in each case both wheels stand within 100 ms
// and the ramp, or the controller sends nothing any more within that time and the drives' own watchdogs stop them.
#include <chrono>
#include <functional>

#include "tests/drivers/drive_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::frame;
using Bench = tests::Cia402Bench;

namespace {

/// 2 rad/s at the 10/3 rad/s2 that the setup calls a ramp.
constexpr Duration kRamp = 600ms, kLimit = 100ms + kRamp;
const CanFrame kPreOperationalLeft = frame(0x000, {0x80, 5}), kPreOperationalAll = frame(0x000, {0x80, 0}),
               kStopAll = frame(0x000, {0x02, 0}), kResetLeft = frame(0x000, {0x81, 5}),
               kResetCommunicationLeft = frame(0x000, {0x82, 5});

/// Goes on wanting 2 rad/s of both wheels for the limit, `meanwhile` in every tick.
void check_stops(Bench& bench, const std::function<void()>& meanwhile = {}) {
  const Time cause = bench.clock.now();
  Time stood = kNever;
  while (bench.clock.now() < cause + kLimit + 400ms) {
    if (meanwhile) meanwhile();
    bench.drive(2.0, 2.0, 1);
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

TEST_CASE("drives taken out of operation, one or both, or made to forget whom they watch stop both wheels") {
  for (const CanFrame& said : {kPreOperationalLeft, kPreOperationalAll, kResetCommunicationLeft}) {
    CAPTURE(said);
    with_and_without_hearing([&said](Bench& bench) {
      bench.stranger_says(said);
      check_stops(bench);
    });
  }
}

TEST_CASE("drives that are NMT-stopped again and again stop by their own watchdogs") {
  with_and_without_hearing([](Bench& bench) {
    Time next = bench.clock.now();
    check_stops(bench, [&] {
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

TEST_CASE("a drive that ignores the quick stop because of the other's fault is stopped by its watchdog") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.stick();
  bench.right.raise_fault(0x2310);
  check_stops(bench);
  CHECK(bench.base.trouble() == DriveTrouble::kEmergency);
}

TEST_CASE("a drive that has left the network state is quick-stopped by SDO before its watchdog acts") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.objects().set({0x1016, 1}, 0);  // it watches nobody any more
  bench.stranger_says(kPreOperationalLeft);
  bench.drive(2.0, 2.0, 12);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a drive that answers every SYNC and says no heartbeat any more is missed") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.objects().set({0x1017, 0}, 0);
  bench.drive(2.0, 2.0, 16);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveSilent);
  CHECK(bench.is_at_rest());
}
