// What a CiA 402 drive must show again before it turns a wheel after it restarted, dropped out or was not obeyed.
#include <chrono>

#include "tests/drivers/drive_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::frame;
using Bench = tests::Cia402Bench;

namespace {

/// A reset, and ticks that want the wheels to turn, until the proof is over.
void reset_and_await_proof(Bench& bench) {
  bench.base.reset();
  for (int k = 0; k < 250 && !bench.base.is_proved() && bench.base.trouble() == DriveTrouble::kNone; ++k) {
    bench.drive(2.0, 2.0, 1);
    REQUIRE(bench.is_at_rest());
    REQUIRE_FALSE(bench.base.is_enabled());
  }
}

void check_drives_again(Bench& bench) {
  CHECK(bench.base.is_proved());
  bench.drive(2.0, 2.0, 20);  // zero first
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 10);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK(bench.left.velocity() == Approx(2000.0));
  CHECK(bench.right.velocity() == Approx(-2000.0));
}

}  // namespace

TEST_CASE("a self-starting drive that lost power is proved anew, whole, before it turns") {
  Bench bench;
  bench.left.start_by_itself();
  bench.bring_to_two_radps();
  bench.left.objects().set({0x1016, 1}, 0);
  bench.left.objects().set({0x6007, 0}, 0);
  bench.left.objects().store();  // what it comes back with: process data, and watching nobody
  bench.drive(0.0, 0.0, 30);
  bench.left.restart();
  bench.drive(0.0, 0.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveRestarted);
  CHECK_FALSE(bench.base.is_proved());
  reset_and_await_proof(bench);
  CHECK(bench.left.objects().value({0x1016, 1}) == 0x00010064);
  CHECK(bench.left.objects().value({0x6007, 0}) == 3);
  check_drives_again(bench);
  bench.clock.sleep_until(bench.clock.now() + 182ms);  // and when the controller dies, it stops
  CHECK(bench.is_at_rest());
}

TEST_CASE("what a drive could not prove at arming it need not prove later, and what it could it must") {
  canopen::DriveBaseSetup setup = tests::two_axes();
  setup.allow_unproved = true;
  Bench bench(setup);
  bench.left.objects().lack({0x605E, 0});
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.left.restart();
  bench.drive(0.0, 0.0, 10);
  reset_and_await_proof(bench);
  check_drives_again(bench);
  bench.drive(0.0, 0.0, 30);
  bench.left.restart();
  bench.left.objects().lie_about({0x1016, 1});
  bench.drive(0.0, 0.0, 10);
  reset_and_await_proof(bench);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
}

TEST_CASE("another drive in the place of one that was armed is refused") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.left.restart();
  bench.left.objects().fix({0x1018, 4}, 8);
  bench.drive(0.0, 0.0, 10);
  reset_and_await_proof(bench);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  bench.drive(0.0, 0.0, 20);
  CHECK_FALSE(bench.left.is_enabled());
  CHECK(bench.wheels.stop == StopStage::kSilent);
}

TEST_CASE("a drive that restarts while it is proved again, or after, has to be proved once more") {
  Bench bench;
  bench.left.start_by_itself();
  bench.bring_to_two_radps();
  bench.left.objects().store();
  bench.drive(0.0, 0.0, 30);
  bench.right.pull_cable();
  bench.drive(0.0, 0.0, 20);
  bench.right.plug_cable();
  bench.base.reset();
  bench.drive(0.0, 0.0, 40);
  bench.left.restart();
  bench.drive(0.0, 0.0, 150);
  const bool is_proved_with_watch = bench.base.is_proved() && bench.left.objects().value({0x1016, 1}) == 0x00010064;
  CHECK((is_proved_with_watch || bench.base.trouble() != DriveTrouble::kNone));
}

TEST_CASE("a wheel that still turns is not proved") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.left.restart();  // no torque: it rolls out for seconds
  bench.drive(2.0, 2.0, 10);
  bench.base.reset();
  bench.drive(2.0, 2.0, 100);
  REQUIRE(bench.left.velocity() > 300.0);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
}

TEST_CASE("nothing feeds a drive while it is proved, and no drive has torque then") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.right.raise_fault(0x2310);
  bench.drive(0.0, 0.0, 20);
  bench.base.reset();
  bench.drive(0.0, 0.0, 20);  // 300 ms of them it only listens
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK_FALSE(bench.base.is_proved());
  CHECK(bench.left.heard_controller() == kNever);
  CHECK_FALSE(bench.left.is_enabled());
  bench.base.reset();  // once more does not begin it anew
  bench.drive(0.0, 0.0, 100);
  CHECK(bench.base.is_proved());
  CHECK(bench.base.is_enabled());
}

TEST_CASE("with any of a master's frames on the bus the drives are not armed, and the frame is named") {
  struct Said {
    CanFrame frame;
    const char* named;
  };
  const std::array<Said, 7> cases{
      {{frame(0x701, {5}), "heartbeat of node 1 (701#05)"},
       {frame(0x000, {1, 0}), "NMT command (000#0100)"},
       {frame(0x080, {}), "SYNC (080#)"},
       {frame(0x206, {0x0F, 0, 1, 0, 0, 0}), "process data to node 6 (206#0F0001000000)"},
       {frame(0x505, {0}), "process data to node 5 (505#00)"},
       {frame(0x605, {0x40, 0x41, 0x60, 0, 0, 0, 0, 0}), "SDO request to node 5 (605#4041600000000000)"},
       {frame(0x586, {0x4B, 0x41, 0x60, 0, 0, 0, 0, 0}),
        "SDO answer that was not asked for, of node 6 (586#4B41600000000000)"}}};
  for (const Said& said : cases) {
    Bench bench;
    bool spoke = false;
    bench.clock.meanwhile = [&] {
      if (!spoke && bench.clock.now() > Time{200ms}) bench.stranger_says(said.frame), spoke = true;
    };
    CHECK(bench.armed() == "CAN: another master on the bus: " + std::string(said.named) +
                               "; end the other program or machine, or give it a bus of its own");
    CHECK_FALSE(bench.left.is_enabled());
  }
}

TEST_CASE("a stranger that speaks while the drives are proved again ends the proof") {
  Bench bench;
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.right.raise_fault(0x2310);
  bench.drive(0.0, 0.0, 20);
  bench.base.reset();
  bench.drive(0.0, 0.0, 40);
  bench.stranger_says(frame(0x701, {5}));
  bench.drive(0.0, 0.0, 150);
  CHECK(bench.base.trouble() == DriveTrouble::kForeignMaster);
  CHECK_FALSE(bench.left.is_enabled());
}
