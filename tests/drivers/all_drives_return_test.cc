// Drives of every kind that restart, drop out or come back: nothing has torque before the whole proof of both
// (SAFETY 15). A second program that commands the same drives: refused at arming, a latched fault at once later
// (SAFETY 16).
#include <chrono>

#include "tests/drivers/drive_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::drive_kinds;
using tests::DriveBench;
using tests::DriveKind;
using tests::with_each_kind;
using tests::with_each_side;

namespace {

/// An emergency stop that cuts the left drive's power for half a second, and a robot that stands.
void cut_power(DriveBench& bench) {
  bench.bring_to_two_radps();
  bench.drive(0.0, 0.0, 30);
  bench.pull_cable(0);
  bench.drive(0.0, 0.0, 25);
  bench.restart(0);
  bench.plug_cable(0);
  bench.drive(0.0, 0.0, 10);
  CHECK(bench.drives().trouble() == DriveTrouble::kDriveSilent);
  CHECK_FALSE(bench.drives().is_proved());
}

/// A reset, and ticks that want the wheels to turn, until the proof is over and both obey after a command of zero.
void reset_and_drive(const DriveKind& kind, DriveBench& bench) {
  bench.drives().reset();
  for (int k = 0; k < kind.proof_ticks && !bench.drives().is_proved(); ++k) {
    bench.drive(2.0, 2.0, 1);
    REQUIRE(bench.is_at_rest());
  }
  CHECK(bench.drives().is_proved());
  bench.drive(2.0, 2.0, 20);  // a command of zero is still owed
  CHECK(bench.is_at_rest());
  bench.drive(0.0, 0.0, 20);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.drives().trouble() == DriveTrouble::kNone);
  bench.require_two_radps();
  CHECK(bench.heap_calls == 0);
}

}  // namespace

TEST_CASE("drives are proved whole after a power cut and then both wheels obey") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    cut_power(bench);
    reset_and_drive(kind, bench);
  });
}

TEST_CASE("a drive that lost its watch while it was off is not enabled again, nor is the other one") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    cut_power(bench);
    kind.lose_watch(bench, side);
    for (int resets = 0; resets < 2; ++resets) {
      bench.drives().reset();
      bench.drive(0.0, 0.0, kind.proof_ticks);
      CHECK(bench.drives().trouble() == DriveTrouble::kNotProved);
      bench.drive(2.0, 2.0, 50);
      CHECK(bench.is_at_rest());
      CHECK_FALSE((bench.has_torque(0) || bench.has_torque(1)));
      CHECK_FALSE((bench.drives().is_proved() || bench.drives().is_enabled()));
      CHECK(bench.wheels.trouble == DriveTrouble::kNotProved);
    }
    kind.restore_watch(bench, side);
    bench.drives().reset();
    bench.drive(0.0, 0.0, kind.proof_ticks);
    bench.drive(2.0, 2.0, 50);
    bench.require_two_radps();
  });
}

TEST_CASE("a reset while a drive is still away fails its proof") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.drive(0.0, 0.0, 30);
    bench.pull_cable(0);
    bench.drive(0.0, 0.0, 25);
    CHECK(bench.drives().trouble() == DriveTrouble::kDriveSilent);
    bench.drives().reset();
    bench.drive(0.0, 0.0, kind.absent_ticks);
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
    bench.drive(0.0, 0.0, kind.given_up_ticks - kind.absent_ticks);
    CHECK(bench.drives().trouble() == DriveTrouble::kNotProved);
    bench.restart(0);
    bench.plug_cable(0);
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.is_at_rest());
  });
}

TEST_CASE("a drive that restarts under way is noticed, stops the other one and is proved anew") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    bench.bring_to_two_radps();
    const double turned_rad = bench.wheels.left_rad;
    bench.restart(side);
    bench.drive(2.0, 2.0, kind.stop_ticks + 5);
    CHECK(bench.drives().trouble() == kind.restarted);
    CHECK(bench.wheel_radps(1 - side) == 0.0);
    CHECK(bench.wheels.left_rad >= turned_rad);
    bench.wait(21s);  // without torque it rolls out
    reset_and_drive(kind, bench);
  });
}

TEST_CASE("a restart at rest that is over before anything is missed is noticed all the same") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.drive(0.0, 0.0, 50);
    const double turned_rad = bench.wheels.left_rad;
    bench.restart(0);
    bench.drive(0.0, 0.0, 10);
    CHECK(bench.drives().trouble() == kind.restarted);
    CHECK(bench.wheels.left_rad == Approx(turned_rad));
  });
}

TEST_CASE("a position that jumps by 100 rad is trouble, no way, and both drives are proved anew") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    bench.bring_to_two_radps();
    const double left_rad = bench.wheels.left_rad, right_rad = bench.wheels.right_rad;
    kind.jump(bench, side);
    bench.drive(2.0, 2.0, 5);
    CHECK(bench.drives().trouble() == DriveTrouble::kDriveRestarted);
    CHECK(bench.wheels.left_rad == Approx(left_rad).margin(0.3));
    CHECK(bench.wheels.right_rad == Approx(right_rad).margin(0.3));
    bench.wait(21s);
    reset_and_drive(kind, bench);
  });
}

// Every boot that a counter or a silence can show: one that takes less than the 150 ms of silence which are allowed,
// before the wheel ever turned, changes nothing that a VESC tells.
TEST_CASE("a drive that restarts at rest is noticed however far it had turned, and both are proved anew") {
  for (const int turning_ticks : {0, 5, 200}) {
    for (const Duration boots : {Duration{0}, Duration{100ms}, Duration{600ms}}) {
      if (turning_ticks == 0 && boots < 150ms) continue;
      CAPTURE(turning_ticks, boots.count());
      with_each_side([&](const DriveKind& kind, DriveBench& bench, std::size_t side) {
        REQUIRE(bench.armed() == "armed");
        bench.drive(0.0, 0.0, 20);
        bench.drive(2.0, 2.0, turning_ticks);
        bench.drive(0.0, 0.0, 60);
        REQUIRE(bench.drives().is_proved());
        bench.pull_cable(side);
        bench.wait(boots);
        bench.plug_cable(side);
        bench.restart(side);
        bench.drive(0.0, 0.0, 10);
        CHECK(bench.drives().trouble() != DriveTrouble::kNone);
        CHECK_FALSE(bench.drives().is_proved());
        reset_and_drive(kind, bench);
      });
    }
  }
}

TEST_CASE("a second drive with the number of one of ours, there from the start, is told before a wheel turns") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    if (!kind.reserved_id) return;
    bench.add_twin(side);
    const bool armed = bench.armed() == "armed";
    bench.drive(0.0, 0.0, 10);
    CHECK((!armed || bench.drives().trouble() == DriveTrouble::kForeignMaster));
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.is_at_rest());
  });
}

TEST_CASE("a second drive with the number of one of ours that comes under way is trouble, and both wheels stop") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    if (!kind.reserved_id) return;
    bench.bring_to_two_radps();
    bench.add_twin(side);
    bench.drive(2.0, 2.0, 5);
    CHECK(bench.drives().trouble() != DriveTrouble::kNone);
    bench.drive(2.0, 2.0, kind.stop_ticks + 150);
    CHECK(bench.wheel_radps(0) + bench.wheel_radps(1) == Approx(0.0).margin(1e-9));
  });
}

TEST_CASE("a drive whose cable is pulled is missed and the other stopped") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.pull_cable(0);
    bench.drive(2.0, 2.0, 8 + kind.stop_ticks);  // 150 ms until it is missed
    CHECK(bench.drives().trouble() == DriveTrouble::kDriveSilent);
    CHECK(bench.wheel_radps(1) == 0.0);
    CHECK((!kind.brakes_itself || bench.is_at_rest()));
  });
}

TEST_CASE("after falling silent a reset speaks to the drives again and they drive") {
  with_each_side([](const DriveKind& kind, DriveBench& bench, std::size_t side) {
    bench.bring_to_two_radps();
    kind.need_restart(bench, side);
    bench.drive(0.0, 0.0, 250);
    CHECK(bench.wheels.stop == StopStage::kSilent);
    bench.restart(side);
    bench.plug_cable(side);
    bench.drives().reset();
    bench.drive(0.0, 0.0, kind.proof_ticks + 30);
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
    bench.require_two_radps();
  });
}

TEST_CASE("a reset where the drives were in no trouble proves nothing anew") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    bench.drive(0.0, 0.0, 30);
    bench.drives().reset();
    CHECK(bench.drives().is_proved());
    bench.drive(2.0, 2.0, 20);
    CHECK(bench.is_at_rest());  // but it takes a command of zero
    bench.drive(0.0, 0.0, kind.enabling_ticks);
    CHECK(bench.drives().is_enabled());
    bench.drive(2.0, 2.0, 50);
    bench.require_two_radps();
  });
}

TEST_CASE("drives that hear another master are not armed") {
  for (const DriveKind& kind : drive_kinds()) {
    for (const CanFrame& said : kind.masters) {
      CAPTURE(kind.name, said);
      const auto bench = kind.make({});
      bool spoke = false;
      bench->clock.meanwhile = [&] {
        if (!spoke && bench->clock.now() > Time{200ms}) bench->stranger_says(said), spoke = true;
      };
      const std::string refusal = bench->armed();
      CHECK(refusal.substr(0, kind.foreign.size()) == kind.foreign);
      bench->drive(0.0, 0.0, 10);
      bench->drive(2.0, 2.0, 20);
      CHECK(bench->is_at_rest());
    }
  }
}

TEST_CASE("a foreign master's frame under way is a latched fault by the next tick, kept, and stops both wheels") {
  for (const DriveKind& kind : drive_kinds()) {
    for (const CanFrame& said : kind.masters) {
      CAPTURE(kind.name, said);
      const auto bench = kind.make({});
      bench->bring_to_two_radps();
      bench->stranger_says(said);
      bench->drive(2.0, 2.0, 1);
      CHECK(bench->wheels.trouble == DriveTrouble::kForeignMaster);
      CHECK(bench->drives().foreign_frame() == said);
      bench->drive(2.0, 2.0, 150);
      CHECK(bench->drives().trouble() == DriveTrouble::kForeignMaster);
      CHECK(bench->is_at_rest());
      reset_and_drive(kind, *bench);  // it was one frame
      CHECK_FALSE(bench->drives().foreign_frame());
    }
  }
}

TEST_CASE("frames of others that mean neither drive are no foreign master") {
  with_each_kind([](const DriveKind& kind, DriveBench& bench) {
    bench.bring_to_two_radps();
    for (const CanFrame& other : kind.strangers) bench.stranger_says(other);
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.drives().trouble() == DriveTrouble::kNone);
  });
}
