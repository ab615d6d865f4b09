// Drives as they are built on the whole robot: rows of the fault matrix, and what the status says of them.
#include <algorithm>

#include "hil/faults/fault_matrix.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using faults::FaultBench;

namespace {

const faults::FaultCase& row(std::string_view name) {
  return *std::ranges::find_if(faults::all_cases(), [&](const faults::FaultCase& fault) { return fault.name == name; });
}

std::string status_of(FaultBench& bench) { return bench.robot().desk().obey("status"); }

}  // namespace

TEST_CASE("a robot whose drives show their mode 30 ms after they are enabled comes up to speed and stops") {
  const Scratch folder;
  FaultBench bench(row("mode_shown_late"), DriveKind::kCia402, 0.6, 50.0, folder.folder());
  CHECK(bench.suffer().why_not == "");
}

TEST_CASE("VESCs below their minimum ERPM latch wheels_disobey, and the status names minimum ERPM and the figure") {
  for (const double speed_mps : {0.3, 0.6}) {
    const Scratch folder;
    FaultBench bench(row("below_minimum_erpm"), DriveKind::kVesc, speed_mps, 50.0, folder.folder());
    const faults::FaultResult result = bench.suffer();
    CHECK(result.why_not == "");
    CHECK(result.stop_distance_m < 0.01);
    CHECK(status_of(bench).find("minimum ERPM lies above; set that to 0") != std::string::npos);
  }
}

TEST_CASE("VESCs without a minimum ERPM drive as they did") {
  faults::FaultCase stop = row("emergency_stop");
  stop.from_start = [](FaultBench& b) { b.left_drive().let_go_below(0.0), b.right_drive().let_go_below(0.0); };
  const Scratch folder;
  FaultBench bench(stop, DriveKind::kVesc, 0.6, 50.0, folder.folder());
  CHECK(bench.suffer().why_not == "");
}

TEST_CASE("a drive's fault stands in the status with node, code and meaning") {
  const Scratch folder;
  FaultBench bench(row("drive_fault_left"), DriveKind::kVesc, 0.6, 50.0, folder.folder());
  CHECK(bench.suffer().why_not == "");
  CHECK(status_of(bench).find("\ndrive_fault: VESC 23: fault 33 (not known)\n") != std::string::npos);
}

TEST_CASE("a Pioneer's stop button stands in the status, and its watchdog from the factory takes two seconds") {
  const Scratch folder;
  FaultBench bench(row("stop_button"), DriveKind::kPioneer, 0.6, 50.0, folder.folder());
  CHECK(bench.suffer().why_not == "");
  CHECK(status_of(bench).find("\ndrive_fault: Pioneer: stop button pressed\n") != std::string::npos);
  const Scratch other;
  FaultBench factory(row("factory_watchdog"), DriveKind::kPioneer, 0.6, 50.0, other.folder());
  const faults::FaultResult result = factory.suffer();
  CHECK(result.why_not == "");
  CHECK(result.reaction > std::chrono::milliseconds(1900));
}
