// A scripted person drives a simulated robot by a stick: nothing is touched, the door is passed.
#include <cmath>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Whether it comes to the goal within the time; it touches nothing.
bool arrives(const std::string& scenario, const RobotModel& model, std::uint64_t seed, double limit_s) {
  SimulatedDrive drive(scenario, seed, [&](sim::Scenario& s) { s.model = model; });
  const bool arrived = drive.drive(limit_s, [&](const TickRecord& t) {
    return drive.to_goal_m() < t.input.goal_tolerance_m || drive.truth().contacts > 0;
  });
  CAPTURE(scenario, model.name, seed);
  CHECK(drive.truth().contacts == 0);
  return arrived;
}

}  // namespace

TEST_CASE("full ahead into a wall, by either mode, the robot stands before it and touches nothing") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  const StickUse steering = GENERATE(StickUse::kShared, StickUse::kByHand);
  SimulatedDrive drive("stick_wall", 5, [&](sim::Scenario& s) { s.model = model, s.stick->steering = steering; });
  drive.drive(15.0, [&](const TickRecord&) { return drive.truth().contacts > 0; });
  CAPTURE(model.name);
  CHECK(drive.truth().contacts == 0);
  CHECK(drive.truth().clearance_m < 0.2);
  CHECK(std::fabs(drive.truth().twist.v_mps) < 0.02);
}

TEST_CASE("a door of 0.90 m that lies 10 cm beside the way of a stick held straight is passed") {
  CHECK(arrives("stick_door", p3dx(), 3, 40.0));
  CHECK(arrives("stick_door", wheelchair(), 3, 40.0));
}

TEST_CASE("an emergency stop of a robot that is steered is latched, and the stick moves nothing") {
  SimulatedDrive drive("stick_crowd", 4, [](sim::Scenario& s) {
    s.wanderers.clear();
    s.faults.push_back({.at_s = 3.0, .for_s = 0.5, .kind = sim::FaultKind::kEmergencyStop});
  });
  drive.drive(3.0);
  CHECK(drive.truth().twist.v_mps > 0.4);
  drive.drive(5.0);
  CHECK(drive.truth().twist.v_mps == Approx(0.0).margin(1e-6));
  CHECK(drive.loop().mode() == Mode::kLatched);
}
