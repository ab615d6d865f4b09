// Drills: a wheel that does not stop when it is told to. Both stand within 100 ms and the ramp of the order, or nothing
// is sent any more from then on (SAFETY 14).
#include <chrono>
#include <functional>

#include "tests/drivers/odrive_bench.h"
#include "tests/drivers/vesc_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

/// 100 ms and the ramp from 2 rad/s: 250 ms at 8 rad/s2, 133 ms at 15 rad/s2. Ticks begin 20 ms apart.
constexpr Duration kOdriveLimit = 350ms, kVescLimit = 233ms;

/// What has to be seen within `limit` of the order, and half a second on.
template <class Bench>
void stops_or_falls_silent(Bench& bench, double commanded_radps, Duration limit) {
  const Time order = bench.clock.now();
  while (bench.clock.now() - order < limit) bench.drive(commanded_radps, commanded_radps, 1);
  const bool rested = bench.is_at_rest();
  for (int k = 0; k < 25; ++k) {
    bench.drive(commanded_radps, commanded_radps, 1);
    REQUIRE((bench.port.last() - order <= limit || (rested && bench.is_at_rest())));
  }
  CHECK(bench.base.trouble() != DriveTrouble::kNone);
  CHECK(bench.wheels.stop == StopStage::kSilent);
  CHECK(bench.heap_calls == 0);
}

template <class Bench>
void drill(const std::function<void(Bench&)>& fault, double commanded_radps, Duration limit) {
  Bench bench;
  bench.bring_to_two_radps();
  fault(bench);
  stops_or_falls_silent(bench, commanded_radps, limit);
  bench.drive(2.0, 2.0, 150);  // what watches them rolls them out at 1 rad/s2, and nothing wakes them
  CHECK(bench.is_at_rest());
}

using OnOdrives = std::function<void(tests::OdriveBench&)>;
using OnVescs = std::function<void(tests::VescBench&)>;

}  // namespace

TEST_CASE("an ODrive axis that goes on at its old speed when told zero is left to its watchdog") {
  for (const OnOdrives& fault :
       {OnOdrives([](auto& b) { b.left.stick(); }), OnOdrives([](auto& b) { b.right.stick(); }),
        OnOdrives([](auto& b) { b.left.go_deaf(); }), OnOdrives([](auto& b) { b.right.go_deaf(); })}) {
    drill<tests::OdriveBench>(fault, 0.0, kOdriveLimit);
  }
}

TEST_CASE("a VESC that goes on at its old speed when told zero is left to its timeout") {
  for (const OnVescs& fault :
       {OnVescs([](auto& b) { b.left.stick(); }), OnVescs([](auto& b) { b.right.stick(); }),
        OnVescs([](auto& b) { b.left.go_deaf(); }), OnVescs([](auto& b) { b.right.go_deaf(); })}) {
    drill<tests::VescBench>(fault, 0.0, kVescLimit);
  }
}

TEST_CASE("a stop that one wheel does not tell of counts as unconfirmed") {
  for (const OnOdrives& fault :
       {OnOdrives([](auto& b) { b.left.withhold_estimates(); }), OnOdrives([](auto& b) { b.right.mute(); }),
        OnOdrives([](auto& b) { b.left.pull_cable(); })}) {
    drill<tests::OdriveBench>(fault, 0.0, kOdriveLimit);
  }
  for (const OnVescs& fault :
       {OnVescs([](auto& b) { b.left.mute(); }), OnVescs([](auto& b) { b.right.pull_cable(); })}) {
    drill<tests::VescBench>(fault, 0.0, kVescLimit);
  }
}

TEST_CASE("a wheel that tells nothing more while it drives stops both after the silence limit") {
  // 150 ms and a tick until it is noticed.
  for (const OnOdrives& fault :
       {OnOdrives([](auto& b) { b.left.withhold_estimates(); }), OnOdrives([](auto& b) { b.right.mute(); }),
        OnOdrives([](auto& b) { b.left.pull_cable(); })}) {
    drill<tests::OdriveBench>(fault, 2.0, kOdriveLimit + 170ms);
  }
  for (const OnVescs& fault :
       {OnVescs([](auto& b) { b.left.mute(); }), OnVescs([](auto& b) { b.right.pull_cable(); })}) {
    drill<tests::VescBench>(fault, 2.0, kVescLimit + 170ms);
  }
}

TEST_CASE("a wheel that stays behind a commanded ramp is left to itself 100 ms after the ramp's end") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.left.go_deaf();
  for (double speed = 2.0 - 0.16; speed > 0.0; speed -= 0.16) bench.drive(speed, speed, 1);  // 8 rad/s2
  const Time zero = bench.clock.now();
  bench.drive(0.0, 0.0, 50);
  CHECK(bench.wheels.stop == StopStage::kSilent);
  CHECK(bench.port.last() - zero <= 100ms);
}

TEST_CASE("where one wheel does not stop the other one is braked all the same") {
  tests::OdriveBench bench;
  bench.bring_to_two_radps();
  bench.left.go_deaf();
  bench.drive(0.0, 0.0, 12);  // 4 turns/s at 20 turns/s2: 200 ms
  CHECK(bench.right.velocity() == 0.0);
  CHECK(std::fabs(bench.left.velocity()) > 3.0);
}

TEST_CASE("a stop that both wheels show is no trouble and keeps the drives awake") {
  tests::OdriveBench odrives;
  odrives.bring_to_two_radps();
  odrives.drive(0.0, 0.0, 100);
  CHECK(odrives.wheels.stop == StopStage::kNone);
  CHECK(odrives.base.is_enabled());
  odrives.drive(2.0, 2.0, 50);
  CHECK(odrives.left.velocity() == Approx(4.0));
  tests::VescBench vescs;
  vescs.bring_to_two_radps();
  vescs.drive(0.0, 0.0, 100);
  CHECK(vescs.wheels.stop == StopStage::kNone);
  vescs.drive(2.0, 2.0, 50);
  CHECK(vescs.left.erpm() == Approx(3000.0));
}

TEST_CASE("after falling silent a reset speaks to the drives again and they drive") {
  tests::OdriveBench odrives;
  odrives.bring_to_two_radps();
  odrives.left.go_deaf();
  odrives.drive(0.0, 0.0, 250);
  CHECK(odrives.wheels.stop == StopStage::kSilent);
  odrives.left.restart();
  odrives.base.reset();
  odrives.drive(0.0, 0.0, 60);
  odrives.drive(2.0, 2.0, 50);
  CHECK(odrives.base.trouble() == DriveTrouble::kNone);
  CHECK(odrives.left.velocity() == Approx(4.0));
  CHECK(odrives.right.velocity() == Approx(-4.0));

  tests::VescBench vescs;
  vescs.bring_to_two_radps();
  vescs.right.go_deaf();
  vescs.drive(0.0, 0.0, 250);
  CHECK(vescs.wheels.stop == StopStage::kSilent);
  vescs.right.restart();
  vescs.base.reset();
  vescs.drive(0.0, 0.0, 60);
  vescs.drive(2.0, 2.0, 50);
  CHECK(vescs.base.trouble() == DriveTrouble::kNone);
  CHECK(vescs.left.erpm() == Approx(3000.0));
  CHECK(vescs.right.erpm() == Approx(-3000.0));
}

namespace {

/// At 20 Hz, from each speed: a wheel that ignores the order, then, on a bench anew, one that obeys.
template <class Bench, class Setup>
void stops_at_20_hz(Setup setup) {
  setup.stop = stop_limits(setup.stop.brake_radps2, setup.stop.tolerance_radps, 50ms);
  for (const double speed : {0.55, 0.8, 2.0}) {
    for (const bool obeys : {false, true}) {
      CAPTURE(speed, obeys);
      Bench bench(setup);
      bench.tick = 50ms;
      REQUIRE(bench.armed() == "armed");
      bench.drive(0.0, 0.0, 20);
      bench.drive(speed, speed, 40);
      REQUIRE(bench.base.trouble() == DriveTrouble::kNone);
      if (!obeys) bench.left.stick();
      const Time order = bench.clock.now();
      bench.drive(0.0, 0.0, 40);
      const Duration last = bench.port.last() - order;
      CHECK((bench.wheels.stop == StopStage::kNone) == obeys);
      if (!obeys) CHECK(last <= duration_from_seconds(speed / setup.stop.brake_radps2) + 100ms);
    }
  }
}

}  // namespace

TEST_CASE("at 20 Hz, too, a motor that ignores a stop is told nothing more 100 ms after the ramp") {
  stops_at_20_hz<tests::OdriveBench>(tests::two_odrives());
  stops_at_20_hz<tests::VescBench>(tests::two_vescs());
}
