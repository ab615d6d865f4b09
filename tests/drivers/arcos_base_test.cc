// A Pioneer's board as it is driven: its watchdog that resumes, its flags, its odometry.
#include <algorithm>
#include <chrono>

#include "drivers/can/can_bus.h"
#include "drivers/wired_drive.h"
#include "tests/drivers/drive_bench.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::ArcosBench;

namespace {

constexpr std::uint8_t kStop = 29;

/// A board of 100 ms, as from the factory, and a file that says so.
arcos::BaseSetup of_ten_hz() {
  arcos::BaseSetup setup = Bench::setup();
  setup.times.report_s = 0.1;
  setup.stop = stop_limits(setup.stop.brake_radps2, setup.stop.tolerance_radps, 20ms, setup.times);
  return setup;
}

}  // namespace

TEST_CASE("a Pioneer is told one word a tick, at least 5 ms after the one before") {
  Bench bench;
  Time last = kNever;
  std::size_t heard = 0;
  Duration closest = 1s;
  bench.clock.meanwhile = [&] {
    if (bench.board.commands().size() == heard) return;
    REQUIRE(bench.board.commands().size() == heard + 1);
    heard = bench.board.commands().size();
    if (last != kNever) closest = std::min(closest, bench.clock.now() - last);
    last = bench.clock.now();
  };
  bench.bring_to_two_radps();
  bench.drive(1.0, -1.5, 50);
  CHECK(closest >= 5ms);
}

TEST_CASE("after a gap in which a Pioneer's watchdog tripped the first word is STOP, and no wheel resumes") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.drive(2.0, -2.0, 50);
  bench.wait(400ms);
  REQUIRE(bench.board.has_tripped());
  REQUIRE(bench.is_at_rest());
  const std::size_t heard = bench.board.commands().size();
  bench.drive(2.0, -2.0, 1);
  REQUIRE(bench.board.commands().size() == heard + 1);
  CHECK(bench.board.commands().back() == kStop);
  bench.drive(2.0, -2.0, 50);
  CHECK(bench.is_at_rest());
  CHECK(bench.drives().trouble() == DriveTrouble::kLeftOperation);
}

TEST_CASE("a Pioneer without a watchdog drives where that is allowed") {
  arcos::BaseSetup setup = Bench::setup();
  setup.allow_unproved = true;
  Bench bench(setup);
  bench.board.set_watchdog(0);
  bench.bring_to_two_radps();
  bench.wait(5s);
  bench.require_two_radps();
}

TEST_CASE("an emulated Pioneer whose watchdog tripped goes on with its old command at any word") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.wait(400ms);
  REQUIRE(bench.is_at_rest());
  in_frames(arcos::packet_of({arcos::Command::kPulse}).on_line(), [&](const CanFrame& f) { bench.stranger_says(f); });
  bench.wait(90ms);
  CHECK(bench.wheel_radps(0) > 1.0);
}

TEST_CASE("a Pioneer with the factory's watchdog drives where that is allowed, and rolls on for two seconds") {
  arcos::BaseSetup setup = Bench::setup();
  setup.allow_unproved = true;
  Bench bench(setup);
  bench.board.set_watchdog(2000);
  bench.bring_to_two_radps();
  CHECK(holds(bench.report[0], "Watchdog 2000 (wanted 40 to 100): NOT PROVED"));
  bench.wait(1900ms);
  bench.require_two_radps();
  bench.wait(300ms);
  CHECK(bench.is_at_rest());
}

TEST_CASE("a Pioneer is refused where its settings are not the file's, each with its figures and remedy") {
  const auto refusal = [](void (*change)(emulators::ArcosBoard&)) {
    return tests::armed_after<Bench>([change](Bench& bench) { change(bench.board); });
  };
  CHECK(holds(refusal([](auto& board) { board.set_cycle(100); }), "SipCycle 100 (wanted 20), TicksMM 128, "));
  CHECK(holds(refusal([](auto& board) { board.set_cycle(100); }), "; write that as report_ms in [drive]"));
  CHECK(holds(refusal([](auto& board) { board.set_ticks(138); }), "TicksMM 138 (wanted 128)"));
  CHECK(holds(refusal([](auto& board) { board.limit_ramps(1000, 800); }),
              "TransAccel 1000 (wanted 2000), TransDecel 1000 (wanted 2000), RotAccel 800, "));
  CHECK(holds(refusal([](auto& board) { board.limit_ramps(2000, 300); }), "RotDecel 300 (wanted 800)"));
  CHECK(holds(refusal([](auto& board) { board.set_type("amigo"); }),
              "line: amigo p3dx-sh: is no Pioneer; this drive is for ARCOS boards of type Pioneer"));
  CHECK(holds(refusal([](auto& board) { board.pull_cable(); }), "line: no Pioneer answers; switch it on"));
  CHECK(holds(refusal([](auto& board) { board.press_stop(true); }), "stop button pressed; release the stop button"));
  CHECK(holds(refusal([](auto& board) { board.set_watchdog(39); }), "Watchdog 39 (wanted 40 to 100)"));
  CHECK(holds(refusal([](auto& board) { board.set_watchdog(0); }), "Watchdog 0 (wanted 40 to 100)"));
}

TEST_CASE("a Pioneer's stop button is an emergency, a motor stall a fault, motors switched off have left operation") {
  struct Event {
    void (*strike)(emulators::ArcosBoard&);
    DriveTrouble trouble;
    const char* words;
  };
  const std::array<Event, 3> events{
      {{[](auto& board) { board.press_stop(true); }, DriveTrouble::kEmergency, "Pioneer: stop button pressed"},
       {[](auto& board) { board.stall_motors(true); }, DriveTrouble::kDriveFault, "Pioneer: E_stall"},
       {[](auto& board) { board.switch_off_motors(); }, DriveTrouble::kLeftOperation, ""}}};
  for (const Event& event : events) {
    Bench bench;
    bench.bring_to_two_radps();
    event.strike(bench.board);
    bench.drive(2.0, 2.0, 40);
    CHECK(bench.drives().trouble() == event.trouble);
    CHECK(describe(bench.wheels.fault) == event.words);
    CHECK(bench.is_at_rest());
    bench.board.press_stop(false);
    bench.board.stall_motors(false);
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.is_at_rest());
  }
}

TEST_CASE("a Pioneer of the factory's 100 ms drives, turns and stops at 50 Hz without trouble") {
  Bench bench(of_ten_hz());
  bench.board.set_cycle(100);
  bench.bring_to_two_radps();
  for (const double right : {2.0, -2.0, 1.0, 0.2}) {
    bench.drive(2.0, right, 60);
    CHECK(bench.wheel_radps(1) == Approx(right));
    bench.drive(0.0, 0.0, 60);
    CHECK(bench.is_at_rest());
    REQUIRE(bench.drives().trouble() == DriveTrouble::kNone);
    REQUIRE(bench.wheels.stop == StopStage::kNone);
  }
  bench.drive(2.0, 2.0, 60);
  bench.board.mute();
  bench.drive(2.0, 2.0, 7);  // 2.5 cycles are 250 ms, and the last report is up to 100 ms old
  CHECK(bench.drives().trouble() == DriveTrouble::kNone);
  bench.drive(2.0, 2.0, 7);
  CHECK(bench.drives().trouble() == DriveTrouble::kDriveSilent);
}

TEST_CASE("a Pioneer's odometry comes from its encoders, over the wrap of their counts, or else from its speeds") {
  for (const bool has_encoders : {true, false}) {
    Bench bench(of_ten_hz());
    bench.board.set_cycle(100);
    if (!has_encoders) bench.board.withhold_encoders();
    bench.board.begin_at(32766.0, 4294967296.0 / 128.0 - 50.0);  // both wrap 50 mm on
    const double from_rad = bench.wheel_rad(0);
    bench.bring_to_two_radps();
    CHECK(holds(bench.report[1], has_encoders ? "with encoders" : "no encoders"));
    bench.drive(2.0, 1.0, 100);
    bench.drive(0.0, 0.0, 30);
    CHECK(bench.wheels.left_rad == Approx(bench.wheel_rad(0) - from_rad).margin(has_encoders ? 0.01 : 0.15));
    CHECK(bench.wheels.right_rad == Approx(bench.wheel_rad(1) - from_rad).margin(has_encoders ? 0.01 : 0.15));
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
  }
}
