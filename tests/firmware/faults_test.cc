// What a fault does to the whole drive: it stops, says why, and goes on only when it may.
#include <cmath>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

double speed(const SimulatedDrive& drive) { return std::fabs(drive.truth().twist.v_mps); }

SimulatedDrive stopped_for(sim::FaultKind kind, Reason reason, double named_within_s = 0.3) {
  SimulatedDrive drive = drive_with(kind);
  drive.drive(5.0);
  REQUIRE(speed(drive) > 0.3);
  CHECK(drive.drive(named_within_s, [&](const TickRecord& t) { return has(t.verdict.reasons, reason); }));
  drive.drive(1.5);  // 0.6 m/s at 1 m/s2, and the motors' lag
  CHECK(speed(drive) < 0.01);
  return drive;
}

}  // namespace

TEST_CASE("scans that stop coming, come as no numbers or cut short, and wheels that fall silent stop the robot") {
  stopped_for(sim::FaultKind::kWheelsStale, Reason::kWheelsStale);
  stopped_for(sim::FaultKind::kScanStale, Reason::kScanStale);
  stopped_for(sim::FaultKind::kScanNan, Reason::kScanInvalid);
  stopped_for(sim::FaultKind::kScanShort, Reason::kScanInvalid);
}

TEST_CASE("a scanner that shows one scan again and again stops the robot within half a second") {
  SimulatedDrive drive = stopped_for(sim::FaultKind::kScanFrozen, Reason::kScanFrozen, 0.5);
  drive.drive(4.0);  // the fault is over
  CHECK(speed(drive) > 0.1);
  CHECK(drive.off_m(drive.tick()) < 0.05);
}

TEST_CASE("a wheel without grip for a second does not lose the robot its way") {
  SimulatedDrive drive = drive_with(sim::FaultKind::kWheelSlip);
  double farthest_m = 0.0;
  (void)drive.drive(9.0, [&](const TickRecord& t) {
    farthest_m = std::max(farthest_m, drive.off_m(t));
    return false;
  });
  CHECK(farthest_m < 0.1);
}

TEST_CASE("after an emergency stop the robot stays where it is, button out or not") {
  SimulatedDrive drive = stopped_for(sim::FaultKind::kEmergencyStop, Reason::kEmergencyStop);
  const Vec2 stopped_at = drive.truth().map_from_robot.position();
  drive.drive(8.0);
  CHECK(distance(drive.truth().map_from_robot.position(), stopped_at) < 0.01);
  CHECK(has(drive.tick().verdict.reasons, Reason::kLatched));
}

TEST_CASE("a base whose reports come every 10 to 100 ms, up to 60 ms late, drives to its goal as it states them") {
  const double period_s = GENERATE(0.01, 0.05, 0.1);
  CAPTURE(period_s);
  SimulatedDrive drive("crossing", 1, [&](sim::Scenario& scenario) {
    scenario.wanderers.clear();
    scenario.reports = {period_s, 0.06};
    scenario.model.drive.times = {.report_s = std::max(period_s, 0.02), .late_s = 0.06};
  });
  Reason named = Reason::kNone;
  double off_m = 0.0;
  CHECK(drive.arrives(60.0, [&](const TickRecord& t) {
    named |= without(t.verdict.reasons, kNoFaults);
    off_m = std::max(off_m, drive.off_m(t));
  }));
  CHECK(to_string(named) == "");
  CHECK(off_m < 0.12);
}

TEST_CASE("rain on the scanner does not hold the robot up") {
  const auto seconds_to_goal = [](bool rains) {
    SimulatedDrive drive("crossing", 1, [rains](sim::Scenario& scenario) {
      scenario.wanderers.clear();
      if (rains) scenario.faults = {{.at_s = 2.0, .for_s = 1e3, .kind = sim::FaultKind::kRain}};
    });
    double seconds = 0.0;
    CHECK(drive.arrives(90.0, [&](const TickRecord& t) { seconds = to_seconds(t.now); }));
    return seconds;
  };
  CHECK(seconds_to_goal(true) < 1.15 * seconds_to_goal(false));
}
