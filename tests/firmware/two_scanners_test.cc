// The whole controller with two scanners, on the simulated robot.
#include "hal/types/errors.h"
#include "tests/firmware/relived.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// A second scanner behind, slower than the first.
void add_rear(sim::Scenario& scenario) {
  LaserModel rear = scenario.model.laser;
  rear.robot_from_laser = {-0.2, 0.0, kPi};
  rear.rate_hz = 10.0;
  scenario.model.laser.robot_from_laser = {0.2, 0.0, 0.0};
  REQUIRE(scenario.model.other_lasers.push_back(rear));
}

}  // namespace

TEST_CASE("a robot with two scanners reaches its goal among movers, and asks nothing of the heap") {
  SimulatedDrive drive("crossing", 2, add_rear);
  drive.drive(2.0);
  CHECK(drive.heap_calls(200) == 0);
  CHECK(drive.drive(120.0, [&](const TickRecord&) { return drive.to_goal_m() < 0.3; }));
  CHECK(drive.truth().contacts_caused == 0);
}

TEST_CASE("a recording of two scanners comes to the same commands again") {
  CHECK(different_commands(10.0, add_rear) == 0);
}

TEST_CASE("either of two scanners that is lost or frozen stops it, and it goes on once that is over") {
  const auto [kind, reason] = GENERATE(std::pair{sim::FaultKind::kScanStale, Reason::kScanStale},
                                       std::pair{sim::FaultKind::kScanFrozen, Reason::kScanFrozen});
  const int lost = GENERATE(1, 2);
  SimulatedDrive drive("map1_00", 1, [&, kind = kind](sim::Scenario& scenario) {
    add_rear(scenario);
    scenario.faults = {{.at_s = 5.0, .for_s = 3.0, .kind = kind, .scanner = lost}};
  });
  drive.drive(5.0);
  REQUIRE(drive.truth().twist.v_mps > 0.3);
  bool named = false;
  drive.drive(2.5, [&, reason = reason](const TickRecord& t) {
    named = named || (has(t.verdict.reasons, reason) && t.verdict.faulty_scanners == 1U << (lost - 1));
    return false;
  });
  CHECK(named);
  CHECK(drive.truth().twist.v_mps < 0.01);
  CHECK(drive.drive(5.0, [&](const TickRecord&) { return drive.truth().twist.v_mps > 0.3; }));
}

TEST_CASE("a robot is not driven with another number of scanners than it has") {
  const sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_SCENARIOS) + "/map1_00.toml");
  sim::Simulation one(scenario, 1);
  sim::Scenario with_rear = scenario;
  add_rear(with_rear);
  ControlSetup setup;
  setup.model = with_rear.model;
  const ChosenPlanner planner = make_planner(setup.planner(), Backend::kCpu);
  Recorder nowhere({});
  CHECK_THROWS_AS(ControlLoop(setup, one.hal(), *planner.planner, nowhere), StartupError);
}
