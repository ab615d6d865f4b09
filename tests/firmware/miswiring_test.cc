// A robot whose wheels or scanner are connected wrongly: it stops by itself, says why, and stays so.
#include <algorithm>
#include <cmath>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

SimulatedDrive drive_with(sim::FaultKind kind, double at_s) {
  return {"crossing", 1, [&](sim::Scenario& scenario) {
            scenario.wanderers.clear();
            scenario.faults = {{.at_s = at_s, .for_s = 100.0, .kind = kind}};
          }};
}

/// Turns at 0.3 rad/s, one way and the other, tell it later than a turn on the spot does: docs/safety.md, what does not
/// hold.
constexpr double kToldInTurns_s = 0.7;

/// At 0.2 m/s, or 0.3 rad/s, as the wheels are commanded or feel it.
bool drives(const TickRecord& t, const DriveModel& drive, bool must_turn) {
  const double radius = drive.wheel_radius_m;
  const double turn = radius * std::fabs(t.wheels.right_radps - t.wheels.left_radps) / drive.track_width_m;
  const double rim = radius * std::max({std::fabs(t.command.left_radps), std::fabs(t.command.right_radps),
                                        std::fabs(t.wheels.left_radps), std::fabs(t.wheels.right_radps)});
  return turn >= 0.3 || (!must_turn && rim >= 0.2);
}

/// The fault is named within half a second of driving with it, pauses apart, before `limit_s`, and the robot then
/// stands for good.
void check_told(sim::FaultKind kind, Reason reason, double at_s, double limit_s, bool must_turn = false) {
  CAPTURE(at_s);
  SimulatedDrive drive = drive_with(kind, at_s);
  double driving_s = 0.0, told_s = std::numeric_limits<double>::infinity();
  (void)drive.drive(limit_s, [&](const TickRecord& t) {
    const double now_s = to_seconds(t.now);
    if (now_s >= at_s && drives(t, drive.setup().model.drive, must_turn)) driving_s += to_seconds(drive.setup().tick());
    if (has(t.verdict.reasons, reason)) told_s = now_s;
    return told_s == now_s;
  });
  REQUIRE(told_s < limit_s);
  CHECK(driving_s <= (must_turn ? kToldInTurns_s : 0.5) + 1e-9);
  drive.drive(1.5);
  const Vec2 stopped_at = drive.truth().map_from_robot.position();
  const double heading = drive.truth().map_from_robot.heading;
  drive.drive(3.0);
  CHECK(distance(drive.truth().map_from_robot.position(), stopped_at) < 0.001);
  CHECK(std::fabs(wrap_angle(drive.truth().map_from_robot.heading - heading)) < 0.001);
  CHECK(has(drive.tick().verdict.reasons, Reason::kLatched));
}

}  // namespace

TEST_CASE("reversed motors and a stuck wheel are told from the wheels' feedback, from the start and under way") {
  for (const double at_s : {0.0, 5.0}) {
    for (const auto kind :
         {sim::FaultKind::kBothMotorsReversed, sim::FaultKind::kLeftMotorReversed, sim::FaultKind::kLeftWheelStuck})
      check_told(kind, Reason::kWheelsDisobey, at_s, at_s + 3.0);
  }
}

TEST_CASE("a wheel reversed with its encoder, and wheels without grip, are told from the scans") {
  for (const double at_s : {0.0, 5.0}) {
    for (const auto kind : {sim::FaultKind::kLeftWheelReversed, sim::FaultKind::kNoGrip})
      check_told(kind, Reason::kMotionMismatch, at_s, at_s + 3.0);
  }
}

TEST_CASE("swapped wheels and a mirrored scanner are told from the scans in the first turn") {
  for (const double at_s : {0.0, 5.0}) {
    for (const auto kind : {sim::FaultKind::kWheelsSwapped, sim::FaultKind::kScannerMirrored})
      check_told(kind, Reason::kMotionMismatch, at_s, at_s + 10.0, true);
  }
}

TEST_CASE("a robot that is connected rightly is never accused, among people or on wheels that slip") {
  for (const char* scenario : {"crossing", "long_way_slip", "door"}) {
    CAPTURE(scenario);
    SimulatedDrive drive(scenario, 2);
    const bool accused = drive.drive(40.0, [](const TickRecord& t) {
      return has(t.verdict.reasons, Reason::kWheelsDisobey | Reason::kMotionMismatch);
    });
    CHECK_FALSE(accused);
  }
}

TEST_CASE("in mode paper nothing is accused: its verdicts are not applied") {
  SimulatedDrive drive(
      "crossing", 1,
      [](sim::Scenario& scenario) {
        scenario.faults = {{.at_s = 0.0, .for_s = 100.0, .kind = sim::FaultKind::kLeftWheelReversed}};
      },
      PlanMode::kPaper);
  const bool accused = drive.drive(3.0, [](const TickRecord& t) {
    return has(t.verdict.reasons, Reason::kWheelsDisobey | Reason::kMotionMismatch);
  });
  CHECK_FALSE(accused);
}
