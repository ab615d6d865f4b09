// What every kind of drive does alike, from arming to disarming: once a row of drive_kinds.cc.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "drivers/wired_drive.h"
#include "tests/drivers/drive_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::DriveBench;
using tests::DriveKind;
using tests::with_each_kind;
using tests::with_each_side;

TEST_CASE("wheels turn as commanded and are felt in the same direction") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    CHECK(bench.wheels.left_radps == Approx(2.0));
    CHECK(bench.wheels.right_radps == Approx(2.0));
    CHECK(bench.wheel_rad(0) == Approx(kind.travelled_rad).margin(0.01));
    // What was felt was measured up to two ticks before: 0.08 rad, and a count of rounding.
    CHECK(bench.wheels.left_rad == Approx(bench.wheel_rad(0)).margin(0.09));
    CHECK(bench.wheels.right_rad == Approx(bench.wheels.left_rad).margin(0.01));
    CHECK(bench.wheels.sequence > 50);
    CHECK(bench.clock.now() - bench.wheels.stamp <= 40ms);
    CHECK(bench.heap_calls == 0);
  });
}

TEST_CASE("nothing moves before a command of zero") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    REQUIRE(bench.armed() == "armed");
    bench.wait(1s);  // watchdogs expire meanwhile
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.is_at_rest());
    CHECK_FALSE(bench.drives().is_enabled());
    bench.drive(0.0, 0.0, kind.enabling_ticks);
    CHECK(bench.drives().is_enabled());
    bench.drive(2.0, 2.0, 50);
    bench.require_two_radps();
  });
}

TEST_CASE("a drive whose watch over the controller cannot be proved is not armed, or on record where that is allowed") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    kind.lose_watch(bench, 0);
    CHECK(bench.armed() == kind.unproved + "; " + kind.remedy);
    bench.drive(0.0, 0.0, 20);
    bench.drive(2.0, 2.0, 20);
    CHECK(bench.is_at_rest());
    CHECK_FALSE(bench.drives().is_enabled());
    const auto lax = kind.make({.allow_unproved = true});
    kind.lose_watch(*lax, 0);
    CHECK(lax->armed() == "armed");
    const auto is_unproved = [](const std::string& line) { return line.find("NOT PROVED") != std::string::npos; };
    CHECK(std::count_if(lax->report.begin(), lax->report.end(), is_unproved) == 1);
    CHECK(std::count(lax->report.begin(), lax->report.end(), kind.unproved) == 1);
  });
}

TEST_CASE("disarming takes the torque away, is no trouble, and only a command of zero brings it back") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.drive(0.0, 0.0, 30);
    for (int k = 0; k < kind.disarm_ticks; ++k) {
      static_cast<void>(bench.drives().latest());
      bench.drives().disarm();
      if (k + 1 < kind.disarm_ticks) bench.wait(20ms);
    }
    CHECK_FALSE(bench.drives().is_enabled());
    bench.wait(40ms);
    CHECK_FALSE((bench.has_torque(0) || bench.has_torque(1)));
    CHECK(bench.drives().latest().trouble == DriveTrouble::kNone);
    CHECK_FALSE(bench.drives().is_enabled());
    bench.drive(2.0, 2.0, 20);
    CHECK(bench.is_at_rest());
  });
}

TEST_CASE("drives that are disarmed while they drive are braked first") {
  with_each_kind([](const DriveKind&, DriveBench& bench) {
    bench.bring_to_two_radps();
    for (int k = 0; k < 60; ++k) {  // what is left below the tolerance rolls out
      static_cast<void>(bench.drives().latest());
      bench.drives().disarm();
      bench.wait(20ms);
    }
    CHECK(bench.is_at_rest());
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
    static_cast<void>(bench.drives().latest());
    CHECK_FALSE(bench.drives().is_enabled());
    CHECK_FALSE((bench.has_torque(0) || bench.has_torque(1)));
  });
}

TEST_CASE("a fault of one drive stops both until a reset and a command of zero") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    bench.bring_to_two_radps();
    kind.break_down(bench, side);
    bench.drive(2.0, 2.0, kind.stop_ticks);
    CHECK(bench.drives().trouble() == kind.fault);
    CHECK(bench.wheels.trouble == kind.fault);  // the loop reads it there
    if (side == 1) CHECK(describe(bench.wheels.fault) == kind.broken);
    CHECK(bench.wheel_radps(1 - side) == 0.0);
    bench.drive(0.0, 0.0, 120);  // zero alone does not do
    kind.mend(bench, side);
    bench.drive(2.0, 2.0, 20);
    CHECK(bench.is_at_rest());
    bench.drives().reset();
    bench.drive(2.0, 2.0, kind.proof_ticks);  // nor does a reset alone, and the proof that it begins
    CHECK(bench.drives().is_proved());
    CHECK(bench.is_at_rest());
    bench.drive(0.0, 0.0, kind.enabling_ticks);
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
    bench.drive(2.0, 2.0, 50);
    bench.require_two_radps();
    CHECK_FALSE(bench.wheels.fault.is_told());
  });
}

TEST_CASE("a bus that takes no frames stops the drives") {
  for (const std::size_t refused : {1U, 4U}) {
    with_each_kind([refused](const DriveKind& kind, DriveBench& bench) {
      bench.bring_to_two_radps();
      bench.bus.port(0).refuse_sends(refused);
      bench.drive(2.0, 2.0, kind.stop_ticks + 4);
      CHECK(bench.drives().trouble() == DriveTrouble::kBusRefused);
      CHECK(bench.is_at_rest());
    });
  }
}

TEST_CASE("a controller that is bus-off says so and the drives stop by themselves") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.bus.port(0).set_state(CanState::kBusOff);
    bench.drive(2.0, 2.0, 5);
    CHECK(bench.drives().trouble() == DriveTrouble::kBusUnwell);
    CHECK((kind.brakes_itself || !bench.has_torque(0)));
    bench.drive(2.0, 2.0, 7);
    CHECK((!kind.brakes_itself || bench.is_at_rest()));
  });
}

TEST_CASE("a command that is no number turns no wheel") {
  with_each_kind([](const DriveKind&, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.drive(std::numeric_limits<double>::quiet_NaN(), 2.0, 50);
    CHECK(bench.is_at_rest());
  });
}

TEST_CASE("a thousand ticks ask nothing of the heap and lose no frame") {
  with_each_kind([](const DriveKind&, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.drive(1.0, 1.5, 1000);
    CHECK(bench.heap_calls == 0);
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
    CHECK(bench.bus.port(0).health().frames_lost == 0);
    CHECK(bench.wheel_radps(0) == Approx(1.0));
    CHECK(bench.wheel_radps(1) == Approx(1.5));
  });
}

TEST_CASE("axes that cannot be are refused") {
  for (const DriveKind& kind : tests::drive_kinds()) {
    CAPTURE(kind.name);
    if (kind.reserved_id) {
      CHECK_THROWS_AS(kind.make({.ids = {{7, 7}}}), StartupError);
      CHECK_THROWS_AS(kind.make({.ids = {{7, *kind.reserved_id}}}), StartupError);
    }
    CHECK_THROWS_AS(kind.make({.per_rad = 0.0}), StartupError);
    CHECK_THROWS_AS(kind.make({.per_rad = std::numeric_limits<double>::quiet_NaN()}), StartupError);
  }
}

TEST_CASE("whatever stands on the bus the wheels' state stays finite and a stop stays a stop") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    tests::RandomBytes random(71);
    bool stopped = false;
    for (int k = 0; k < 3000; ++k) {
      for (int burst = 0; burst < 4; ++burst) {
        CHECK(bench.bus.port(3).send(kind.random_frame(random)));
      }
      bench.drive(2.0, 2.0, 1);
      REQUIRE(std::isfinite(bench.wheels.left_rad + bench.wheels.right_rad));
      REQUIRE(std::isfinite(bench.wheels.left_radps + bench.wheels.right_radps));
      REQUIRE((!stopped || bench.drives().trouble() != DriveTrouble::kNone));
      stopped = bench.drives().trouble() != DriveTrouble::kNone;
    }
    CHECK(stopped);
  });
}
