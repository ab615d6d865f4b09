// Drives as they are built on the whole robot: rows of the fault matrix, and what the status says of them.
#include <algorithm>

#include "hil/faults/fault_matrix.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;
using faults::FaultBench;

namespace {

const faults::FaultCase& row(std::string_view name) {
  return *std::ranges::find_if(faults::all_cases(), [&](const faults::FaultCase& fault) { return fault.name == name; });
}

std::string status_of(FaultBench& bench) { return bench.robot().desk().obey("status"); }

}  // namespace

TEST_CASE("VESCs below their minimum ERPM latch wheels_disobey, and the status names minimum ERPM and the figure") {
  for (const double speed_mps : {0.3, 0.6}) {
    const Scratch folder;
    FaultBench bench(row("below_minimum_erpm"), DriveKind::kVesc, speed_mps, 50.0, folder.folder());
    const faults::FaultResult result = bench.suffer();
    CHECK(result.why_not == "");
    CHECK(result.stop_distance_m < 0.01);
    CHECK(holds(status_of(bench), "minimum ERPM lies above; set that to 0"));
  }
}

TEST_CASE("VESCs without a minimum ERPM drive as they did") {
  faults::FaultCase stop = row("emergency_stop");
  stop.from_start = [](FaultBench& b) { b.drive(0).let_go_below(0.0), b.drive(1).let_go_below(0.0); };
  const Scratch folder;
  FaultBench bench(stop, DriveKind::kVesc, 0.6, 50.0, folder.folder());
  CHECK(bench.suffer().why_not == "");
}

TEST_CASE("a drive's fault stands in the status with node, code and meaning, and a Pioneer's stop button does") {
  struct Shown {
    const char* fault;
    DriveKind kind;
    const char* line;
  };
  for (const auto& [fault, kind, line] :
       {Shown{"drive_fault_left", DriveKind::kVesc, "\ndrive_fault: VESC 23: fault 33 (not known)\n"},
        Shown{"stop_button", DriveKind::kPioneer, "\ndrive_fault: Pioneer: stop button pressed\n"}}) {
    CAPTURE(fault);
    const Scratch folder;
    FaultBench bench(row(fault), kind, 0.6, 50.0, folder.folder());
    CHECK(bench.suffer().why_not == "");
    CHECK(holds(status_of(bench), line));
  }
}
