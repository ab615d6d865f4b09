#include <filesystem>
#include <string>

#include "hal/maps/wall_map.h"
#include "hal/sim/simulation.h"
#include "tests/recording/recordings.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

Scenario own(const std::string& name) {
  return load_scenario(std::filesystem::path(JAYWALK_OWN_SCENARIOS) / (name + ".toml"));
}

double shortest(const Scenario& scenario) { return Simulation(scenario, scenario.seed).static_shortest_path_m(); }

}  // namespace

TEST_CASE("the four maps' shortest paths are the paper's: 46, 67, 48 and 49 m within 3 percent") {
  const std::pair<const char*, double> maps[] = {
      {"map1_00", 46.0}, {"map2_00", 67.0}, {"map3_00", 48.0}, {"map4_00", 49.0}};
  for (const auto& [name, shortest_m] : maps) {
    const Scenario scenario = own(name);
    CHECK(shortest(scenario) == Approx(shortest_m).epsilon(0.03));
    // In opposite corners: a window of 25.6 m between start and goal holds the map.
    CHECK(distance((scenario.start.position() + scenario.goal) * 0.5, Vec2{12.8, 12.8}) < 0.1);
  }
}

TEST_CASE("the long way is one of 100 m for a robot that keeps off the walls, on wheels that slip") {
  // Round the four walls' ends at a body's half width, 0.19 m: 19.9 m to the first, three times 17.5 m (16.8 across,
  // 5.1 up), 19.8 m from the last.
  const Scenario scenario = own("long_way_slip");
  CHECK(shortest(scenario) == Approx(92.2).epsilon(0.02));
  CHECK(scenario.slip.mean == 0.05);
  CHECK(scenario.slip.std == 0.05);
  CHECK(scenario.goal_tolerance_m == 0.2);
}

TEST_CASE("every map has scenarios with 0, 1, 4 and 16 movers, which 20 seeds can place") {
  for (const char* map : {"map1", "map2", "map3", "map4"}) {
    for (const int count : {0, 1, 4, 16}) {
      const Scenario scenario = own(std::string(map) + (count < 10 ? "_0" : "_") + std::to_string(count));
      CHECK(scenario.model.limits.max_speed_mps == 0.6);
      CHECK(scenario.timeout_s == 300.0);
      for (std::uint64_t seed = 1; seed <= (count == 16 ? 20U : 1U); ++seed) {
        const Simulation sim(scenario, seed);
        CHECK(sim.truth().movers.size() == static_cast<std::size_t>(count));
        CHECK(sim.truth().clearance_m > 0.5);
      }
    }
  }
}

TEST_CASE("the demo has eight movers and a way from room to room") {
  const Scenario scenario = own("crossing");
  const Simulation sim(scenario, scenario.seed);
  CHECK(sim.truth().movers.size() == 8);
  CHECK(sim.static_shortest_path_m() < 22.0);
}

TEST_CASE("MobileSim's office and a barn of cylinders can be driven in") {
  const auto office = recording("maps/AMROffice.map");
  const auto barn = recording("barn/world_000.txt");
  if (!office || !barn) return;
  Scenario scenario = own("crossing");
  scenario.map_kind = MapKind::kAria;
  scenario.map_file = *office;
  scenario.start = {-5.157, 8.727, 0.0};  // its goal "Outside"
  scenario.goal = {-5.959, 24.231};       // its goal "Far Away"
  Simulation sim(scenario, 1);
  CHECK(sim.walls().size() == 243);
  CHECK(sim.static_shortest_path_m() >= distance(scenario.start.position(), scenario.goal));
  CHECK(sim.static_shortest_path_m() < 25.0);
  CHECK(sim.truth().movers.size() == 8);
  const WallMap cylinders = load_wall_map(MapKind::kCylinders, *barn);
  CHECK(cylinders.discs.front().centre == Vec2{-0.075, 0.075});
  CHECK(cylinders.discs.front().radius_m == 0.075);
}
