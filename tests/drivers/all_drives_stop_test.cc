// Drills with every kind of drive: both wheels stand within 100 ms and the ramp of the order, or nothing is sent any
// more from then on and the drives' own watch stops them (SAFETY 14).
#include <algorithm>
#include <chrono>

#include "tests/drivers/drive_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::drive_kinds;
using tests::DriveBench;
using tests::DriveEvent;
using tests::DriveKind;
using tests::with_each_kind;

namespace {

/// Goes on commanding from 2 rad/s: what has to be seen within `limit`, half a second on, and at the end.
void stops_or_falls_silent(DriveBench& bench, double commanded_radps, Duration limit) {
  const Time order = bench.clock.now();
  while (bench.clock.now() - order < limit) bench.drive(commanded_radps, commanded_radps, 1);
  const bool rested = bench.is_at_rest();
  for (int k = 0; k < 25; ++k) {
    bench.drive(commanded_radps, commanded_radps, 1);
    REQUIRE((bench.port.last() - order <= limit || (rested && bench.is_at_rest())));
  }
  CHECK(bench.drives().trouble() != DriveTrouble::kNone);
  CHECK(bench.wheels.trouble == bench.drives().trouble());
  CHECK(bench.wheels.stop == StopStage::kSilent);
  CHECK(bench.heap_calls == 0);
  bench.drive(2.0, 2.0, 150);  // what watches them stops them, and nothing wakes them
  CHECK(bench.is_at_rest());
}

/// `drill` for each event of each kind and each side.
template <class Drill>
void with_each_event(const std::vector<DriveEvent> DriveKind::*events, Drill drill) {
  for (const DriveKind& kind : drive_kinds()) {
    for (std::size_t event = 0; event < (kind.*events).size(); ++event) {
      for (const std::size_t side : {0U, 1U}) {
        CAPTURE(kind.name, event, side);
        const auto bench = kind.make({});
        bench->bring_to_two_radps();
        (kind.*events)[event](*bench, side);
        drill(kind, *bench, side);
      }
    }
  }
}

Duration owed(const DriveKind& kind) { return 100ms + duration_from_seconds(2.0 / kind.brake_radps2); }

}  // namespace

TEST_CASE("drives stop by themselves when the controller dies") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.wait(kind.own_stop);
    CHECK(bench.is_at_rest());
  });
}

TEST_CASE("a drive that ignores a commanded stop is quick-stopped, and then its watchdog stops it") {
  with_each_event(&DriveKind::disobey, [](const DriveKind& kind, DriveBench& bench, std::size_t) {
    stops_or_falls_silent(bench, 0.0, owed(kind));
    CHECK(bench.drives().trouble() == DriveTrouble::kStopUnconfirmed);
  });
}

TEST_CASE("a stop that one wheel does not tell of counts as unconfirmed") {
  with_each_event(&DriveKind::fall_quiet, [](const DriveKind& kind, DriveBench& bench, std::size_t) {
    stops_or_falls_silent(bench, 0.0, owed(kind));
  });
}

TEST_CASE("a wheel that tells nothing more while it drives stops both after the silence limit") {
  with_each_event(&DriveKind::fall_quiet, [](const DriveKind& kind, DriveBench& bench, std::size_t) {
    stops_or_falls_silent(bench, 2.0, owed(kind) + kind.noticed);
    CHECK(bench.drives().trouble() == DriveTrouble::kDriveSilent);
  });
}

TEST_CASE("a wheel that stays behind a commanded ramp is left to itself 100 ms after the ramp's end") {
  with_each_event(&DriveKind::disobey, [](const DriveKind& kind, DriveBench& bench, std::size_t) {
    const double step = 0.02 * kind.brake_radps2;
    for (double speed = 2.0 - step; speed > 1e-9; speed -= step) bench.drive(speed, speed, 1);
    const Time zero = bench.clock.now();
    bench.drive(0.0, 0.0, 50);
    CHECK(bench.wheels.stop == StopStage::kSilent);
    CHECK(bench.port.last() - zero <= 100ms);
  });
}

TEST_CASE("where one wheel does not stop the other one is braked all the same") {
  with_each_event(&DriveKind::disobey, [](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    // The drives' ramps are a quarter steeper than what they owe.
    const int most = 2 + static_cast<int>(2.0 / kind.brake_radps2 * 0.8 / 0.02);
    for (int k = 0; k < most && bench.wheel_radps(1 - side) > 0.0; ++k) bench.drive(0.0, 0.0, 1);
    CHECK(bench.wheel_radps(1 - side) == 0.0);
    CHECK(bench.wheel_radps(side) > 1.5);
  });
}

TEST_CASE("ordinary stops from any speed are confirmed, trouble nobody and keep the drives awake") {
  with_each_kind([](const DriveKind&, DriveBench& bench) {
    bench.bring_to_two_radps();
    for (const double speed : {2.0, 0.2, 1.0, -2.0, 0.5}) {
      bench.drive(speed, speed, 30);
      bench.drive(speed, -speed, 30);
      bench.drive(0.0, 0.0, 30);
      REQUIRE(bench.drives().trouble() == DriveTrouble::kNone);
      REQUIRE(bench.wheels.stop == StopStage::kNone);
    }
    bench.drive(0.0, 0.0, 100);
    CHECK(bench.wheels.stop == StopStage::kNone);
    CHECK(bench.drives().is_enabled());
    bench.drive(2.0, 2.0, 50);
    bench.require_two_radps();
  });
}

TEST_CASE("once silent the controller sends nothing at all until a reset") {
  with_each_event(&DriveKind::fall_quiet, [](const DriveKind& kind, DriveBench& bench, std::size_t) {
    const int ticks = static_cast<int>((owed(kind) + kind.noticed) / 20ms) + 2;
    bench.drive(2.0, 2.0, ticks);
    REQUIRE(bench.wheels.stop == StopStage::kSilent);
    bench.drive(0.0, 0.0, 30);  // until the other one stands, too
    const auto sent = bench.port.sent();
    bench.drive(2.0, 2.0, 50);
    bench.drive(0.0, 0.0, 50);
    for (int k = 0; k < 20; ++k) bench.drives().disarm();
    CHECK(bench.port.sent() == sent);
  });
}

TEST_CASE("at 20 Hz, too, a drive that ignores a stop is told nothing more 100 ms after the ramp") {
  for (const DriveKind& kind : drive_kinds()) {
    for (const double speed : {kind.tolerance_radps + 0.05, kind.tolerance_radps + 0.4, 2.0}) {
      CAPTURE(kind.name, speed);
      const auto bench = kind.make({.tick = 50ms});
      REQUIRE(bench->armed() == "armed");
      bench->drive(0.0, 0.0, 20);
      bench->drive(speed, speed, 40);
      REQUIRE(bench->drives().trouble() == DriveTrouble::kNone);
      kind.disobey[0](*bench, 0);
      const Time order = bench->clock.now();
      bench->drive(0.0, 0.0, 40);
      CHECK(bench->wheels.stop == StopStage::kSilent);
      CHECK(bench->port.last() - order <= duration_from_seconds(speed / kind.brake_radps2) + 100ms);
      bench->drive(0.0, 0.0, 40);
      CHECK(bench->is_at_rest());
    }
  }
}

TEST_CASE("at 20 Hz ordinary stops are confirmed and trouble nobody") {
  with_each_kind(
      [](const DriveKind&, DriveBench& bench) {
        REQUIRE(bench.armed() == "armed");
        bench.drive(0.0, 0.0, 20);
        for (const double speed : {0.2, 0.4, 0.55, 0.8, 1.0, 2.0, -2.0, 0.5}) {
          for (const double right : {speed, -speed}) {
            bench.drive(speed, right, 40);
            bench.drive(0.0, 0.0, 40);
            REQUIRE(bench.drives().trouble() == DriveTrouble::kNone);
            REQUIRE(bench.wheels.stop == StopStage::kNone);
          }
        }
      },
      {.tick = 50ms});
}

TEST_CASE("a second way tells drives to stand still") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    // In the time of a stop, and before the drives miss the controller, which says nothing any more.
    const Duration limit = std::min(kind.own_stop - 25ms, duration_from_seconds(2.0 / kind.brake_radps2));
    for (Duration braked = 0ms; braked < limit; braked += 25ms) {
      for (const CanFrame& frame : kind.second_way) static_cast<void>(bench.bus.port(3).send(frame));
      bench.wait(25ms);
    }
    CHECK(bench.is_at_rest());
  });
}
