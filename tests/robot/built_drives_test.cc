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

}  // namespace

TEST_CASE("VESCs without a minimum ERPM drive as they did") {
  faults::FaultCase stop = row("emergency_stop");
  stop.from_start = [](FaultBench& b) { b.drive(0).let_go_below(0.0), b.drive(1).let_go_below(0.0); };
  const Scratch folder;
  FaultBench bench(stop, DriveKind::kVesc, 0.6, 50.0, folder.folder());
  CHECK(bench.suffer().why_not == "");
}

TEST_CASE("the status names a drive's node, code and meaning, a Pioneer's stop button and a VESC's minimum ERPM") {
  struct Shown {
    const char* fault;
    DriveKind kind;
    double speed_mps, most_m;  ///< way to rest
    const char* line;
  };
  const char* const erpm = "minimum ERPM lies above; set that to 0";
  for (const auto& [fault, kind, speed_mps, most_m, line] :
       {Shown{"drive_fault_left", DriveKind::kVesc, 0.6, 9.0, "\ndrive_fault: VESC 23: fault 33 (not known)\n"},
        Shown{"stop_button", DriveKind::kPioneer, 0.6, 9.0, "\ndrive_fault: Pioneer: stop button pressed\n"},
        Shown{"below_minimum_erpm", DriveKind::kVesc, 0.3, 0.01, erpm},
        Shown{"below_minimum_erpm", DriveKind::kVesc, 0.6, 0.01, erpm}}) {
    CAPTURE(fault, speed_mps);
    const Scratch folder;
    FaultBench bench(row(fault), kind, speed_mps, 50.0, folder.folder());
    const faults::FaultResult result = bench.suffer();
    CHECK(result.why_not == "");
    CHECK(result.stop_distance_m < most_m);
    CHECK(holds(bench.robot().desk().obey("status"), line));
  }
}
