// CiA 402 drives as their users report them: process data, modes, lengths and positions that differ from the manual.
#include <chrono>
#include <string>

#include "tests/drivers/drive_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::Cia402Bench;

namespace {

/// Arms, enables and drives a wheel at 2 rad/s.
void check_drives(Bench& bench) {
  REQUIRE(bench.armed() == "armed");
  bench.drive(0.0, 0.0, 30);
  bench.drive(2.0, 2.0, 50);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK(bench.wheels.left_radps == Approx(2.0));
}

canopen::DriveBaseSetup lax_setup() {
  canopen::DriveBaseSetup setup = tests::two_axes();
  setup.allow_unproved = true;
  return setup;
}

}  // namespace

TEST_CASE("a drive whose COB-IDs have bit 30 set is armed, whether it keeps the bit or refuses them without") {
  for (const bool strict : {false, true}) {
    CAPTURE(strict);
    Bench bench;
    bench.left.objects().know_no_remote_frames(strict);
    bench.right.objects().know_no_remote_frames(strict);
    check_drives(bench);
    CHECK(bench.left.objects().value({0x1800, 1}) == 0x40000185);
  }
}

TEST_CASE("a drive that shows its mode only once it is enabled, or 400 ms later, is armed and drives") {
  for (const Duration late : {Duration{0}, Duration{30ms}, Duration{400ms}}) {
    CAPTURE(late.count());
    Bench bench;
    bench.left.show_mode_after_enabling(late);
    bench.right.show_mode_after_enabling(late);
    check_drives(bench);
  }
}

TEST_CASE("a drive that never shows profile velocity turns no wheel and is not proved after half a second") {
  Bench bench;
  bench.right.keep_mode(1);
  REQUIRE(bench.armed() == "armed");
  bench.drive(0.0, 0.0, 5);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  CHECK(bench.is_at_rest());
  CHECK_FALSE(bench.wheels.ready);
  bench.drive(2.0, 2.0, 20);
  CHECK(bench.base.trouble() == DriveTrouble::kNotProved);
  CHECK(bench.is_at_rest());
}

TEST_CASE("allow_unproved arms no drive whose process data are refused, and no drive that does not answer") {
  Bench refused(lax_setup());
  refused.left.objects().fix({0x1A00, 1}, 0x606C0020);
  CHECK(refused.armed() ==
        "node 5: 1A00h:1 process data: wanted 60410010h, refused (read only): NOT PROVED; use a drive that can be set "
        "so: it cannot be driven otherwise");
  Bench silent(lax_setup());
  silent.left.pull_cable();
  CHECK(silent.armed().find("no answer: NOT PROVED; see to its cable, its power") != std::string::npos);
}

TEST_CASE("SDO answers that end with their last byte in use and heartbeats of eight bytes are taken") {
  Bench bench;
  bench.left.objects().answer_short();
  bench.left.pad_heartbeats();
  check_drives(bench);
  CHECK(bench.base.inspect(0).starts_with("node 5: CiA 402, profile velocity; 12 of 12 settings"));
}
