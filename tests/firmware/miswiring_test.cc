// A robot whose wheels or scanner are connected wrongly: it stops by itself, says why, and stays so.
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// At 0.2 m/s, or 0.3 rad/s, as the wheels are commanded or feel it.
bool drives(const TickRecord& t, const DriveModel& drive) {
  const double turn =
      drive.wheel_radius_m * std::fabs(t.wheels.right_radps - t.wheels.left_radps) / drive.track_width_m;
  const double rim = drive.wheel_radius_m * std::max({std::fabs(t.command.left_radps), std::fabs(t.command.right_radps),
                                                      std::fabs(t.wheels.left_radps), std::fabs(t.wheels.right_radps)});
  return turn >= 0.3 || rim >= 0.2;
}

/// At 0.3 rad/s, and so tightly that the slower wheel has less than three quarters of the faster one's speed: a wider
/// bend to the wrong side could be a wheel that slips by half (docs/explanation/safety.md, what does not hold).
bool turns(const TickRecord& t, const DriveModel& drive) {
  const double left = t.wheels.left_radps, right = t.wheels.right_radps, apart = std::fabs(right - left);
  return drive.wheel_radius_m * apart / drive.track_width_m >= 0.3 &&
         apart >= 0.25 * std::max(std::fabs(left), std::fabs(right));
}

bool accuses(const TickRecord& t) { return has(t.verdict.reasons, Reason::kWheelsDisobey | Reason::kMotionMismatch); }

using Counts = bool (*)(const TickRecord&, const DriveModel&);

/// How long it has driven with the fault, pauses apart, until that was named; nothing where it was not before
/// `limit_s`.
struct Told {
  std::optional<double> told_s;
  double driving_s = 0.0;
};

Told drive_until_told(SimulatedDrive& drive, Reason reason, double at_s, double limit_s, Counts counts) {
  Told told;
  (void)drive.drive(limit_s, [&](const TickRecord& t) {
    const double now_s = to_seconds(t.now);
    if (now_s >= at_s && counts(t, drive.setup().model.drive)) told.driving_s += to_seconds(drive.setup().tick());
    if (has(t.verdict.reasons, reason)) told.told_s = now_s;
    return told.told_s.has_value();
  });
  return told;
}

/// It stands for good.
void check_stays(SimulatedDrive& drive) {
  drive.drive(1.5);
  const Vec2 stopped_at = drive.truth().map_from_robot.position();
  const double heading = drive.truth().map_from_robot.heading;
  drive.drive(3.0);
  CHECK(distance(drive.truth().map_from_robot.position(), stopped_at) < 0.001);
  CHECK(std::fabs(wrap_angle(drive.truth().map_from_robot.heading - heading)) < 0.001);
  CHECK(has(drive.tick().verdict.reasons, Reason::kLatched));
}

/// The fault is named within half a second of what counts as driving, and the robot then stands.
void check_told(sim::FaultKind kind, Reason reason, double at_s, double limit_s) {
  CAPTURE(static_cast<int>(kind), at_s);
  SimulatedDrive drive = drive_with(kind, at_s, 100.0);
  const Told told = drive_until_told(drive, reason, at_s, limit_s, drives);
  REQUIRE(told.told_s);
  CHECK(told.driving_s <= 0.5 + 1e-9);
  check_stays(drive);
}

}  // namespace

TEST_CASE("reversed motors and a stuck wheel are told from the wheels' feedback, from the start and under way") {
  const double at_s = GENERATE(0.0, 5.0);
  using enum sim::FaultKind;
  const auto kind = GENERATE(kBothMotorsReversed, kLeftMotorReversed, kLeftWheelStuck);
  check_told(kind, Reason::kWheelsDisobey, at_s, at_s + 3.0);
}

TEST_CASE("a wheel reversed with its encoder, and wheels without grip, are told from the scans") {
  const double at_s = GENERATE(0.0, 5.0);
  const auto kind = GENERATE(sim::FaultKind::kLeftWheelReversed, sim::FaultKind::kNoGrip);
  check_told(kind, Reason::kMotionMismatch, at_s, at_s + 3.0);
}

TEST_CASE("swapped wheels and a mirrored scanner are told from the scans in the first tight turn", "[long]") {
  const auto kind = GENERATE(sim::FaultKind::kWheelsSwapped, sim::FaultKind::kScannerMirrored);
  int times_told = 0;
  for (double at_s = 0.0; at_s < 8.5; at_s += 1.0) {
    CAPTURE(static_cast<int>(kind), at_s);
    SimulatedDrive drive = drive_with(kind, at_s, 100.0);
    const Told told = drive_until_told(drive, Reason::kMotionMismatch, at_s, at_s + 10.0, turns);
    CHECK(told.driving_s <= 0.5 + 1e-9);
    if (!told.told_s) continue;  // nor did it turn, as the line before says
    ++times_told;
    check_stays(drive);
  }
  CHECK(times_told >= 6);
}

TEST_CASE("a robot that is connected rightly is never accused, among people or on wheels that slip", "[long]") {
  const std::string scenario = GENERATE("crossing", "long_way_slip", "door");
  CAPTURE(scenario);
  CHECK_FALSE(SimulatedDrive(scenario, 2).drive(40.0, accuses));
}

TEST_CASE("in mode paper nothing is accused: its verdicts are not applied") {
  const auto reverse_a_wheel = [](sim::Scenario& scenario) {
    scenario.faults = {{.at_s = 0.0, .for_s = 100.0, .kind = sim::FaultKind::kLeftWheelReversed}};
  };
  SimulatedDrive drive("crossing", 1, reverse_a_wheel, PlanMode::kPaper);
  CHECK_FALSE(drive.drive(3.0, accuses));
}
