// A world that an operator changes while it goes on: jaywalk sim --endless.
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

TEST_CASE(
    "an operator who plays with the world adds walkers with names of their own, takes them away and begins faults") {
  Scenario scenario = load_scenario(JAYWALK_OWN_SCENARIOS "/map1_04.toml");
  Simulation sim(scenario, 3);
  drive(sim, 6.0, 6.0, 2.0);
  REQUIRE(sim.add_walker());
  drive(sim, 0.0, 0.0, 2.0);
  REQUIRE(sim.truth().movers.size() == 5);
  CHECK(sim.truth().movers.back().id == 5);
  CHECK(norm(sim.truth().movers.back().velocity) > 0.0);
  CHECK(distance(sim.truth().movers.back().position, sim.truth().map_from_robot.position()) > 1.0);
  for (int k = 0; k < 5; ++k) REQUIRE(sim.remove_walker());
  CHECK_FALSE(sim.remove_walker());
  REQUIRE(sim.add_walker());
  drive(sim, 0.0, 0.0, 1.0);
  REQUIRE(sim.truth().movers.size() == 1);
  CHECK(sim.truth().movers.front().id == 6);

  sim.begin_fault(FaultKind::kEmergencyStop, 5.0);
  CHECK(sim.hal().panel.latest().emergency_stop);
  drive(sim, 0.0, 0.0, 5.1);
  CHECK_FALSE(sim.hal().panel.latest().emergency_stop);
}
