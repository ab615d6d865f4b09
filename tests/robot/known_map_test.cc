// A map that a run begins with, read from a ROS map_server file, and a scan's place on it.
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "firmware/recording/map_files.h"
#include "hal/sim/random.h"
#include "hal/sim/simulation.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;

namespace {

const std::string kMaps = JAYWALK_OWN_MAPS;

/// Map of a picture, with the other lines of its YAML file.
std::shared_ptr<const KnownMap> map_of(const std::string& pgm, const std::string& yaml) {
  const Scratch scratch;
  scratch.write("m.pgm", pgm);
  return load_known_map(scratch.write("m.yaml", "image: m.pgm\n" + yaml), 0.1);
}

const std::string kThresholds = "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// What the laser of a P3-DX sees from a pose on one of the project's maps.
LaserScan scan_on(const std::string& map, const Pose2& pose) {
  sim::Scenario scenario;
  scenario.map_file = kMaps + "/" + map + ".yaml";
  scenario.start = pose;
  scenario.goal = pose.position();
  scenario.model = p3dx();
  sim::Simulation simulation(scenario, 3);
  simulation.hal().clock.sleep_until(Time{std::chrono::milliseconds(200)});
  return simulation.hal().laser.latest();
}

std::shared_ptr<const KnownMap> own_map(const std::string& map) {
  return load_known_map(kMaps + "/" + map + ".yaml", 0.1);
}

/// Place on `map` of the scan from a pose on the map `seen_on`, by default the same.
Pose2 located(const std::string& map, const Pose2& pose, const std::string& seen_on = "") {
  return located_on(*own_map(map), scan_on(seen_on.empty() ? map : seen_on, pose), p3dx().laser, "robot.toml: ");
}

/// Maps and their sizes, m.
const std::vector<std::pair<std::string, Vec2>> kFloors{
    {"map1", {25.0, 25.0}}, {"map2", {25.0, 25.0}}, {"map3", {25.0, 25.0}},     {"map4", {25.0, 25.0}},
    {"door", {8.6, 5.4}},   {"corner", {6.0, 6.0}}, {"crossing", {20.0, 14.0}}, {"dead_end", {8.0, 5.0}}};

struct Tally {
  int right = 0, wrong = 0, refused = 0;
  void add(const std::string& map, const LaserScan& scan, const Pose2& pose) try {
    const Pose2 at = located_on(*own_map(map), scan, p3dx().laser, "");
    (distance(at.position(), pose.position()) < 0.3 ? right : wrong) += 1;
  } catch (const StartupError&) {
    ++refused;
  }
};

std::optional<LaserScan> scan_if_free(const std::string& map, const Pose2& pose) try {
  return scan_on(map, pose);
} catch (const StartupError&) {
  return std::nullopt;  // in a wall
}

}  // namespace

TEST_CASE("a map's cells are walls, free or unknown, in cells of 0.1 m whatever its own") {
  // Two columns and one row of 0.2 m from (-0.4, 0): a wall, then free; above them unknown and free.
  const auto map = map_of(std::string("P5\n2 2\n255\n") + '\xCD' + '\xFE' + '\x00' + '\xFE',
                          "resolution: 0.2\norigin: [-0.4, 0.0, 0.0]\n" + kThresholds);
  for (const std::int32_t j : {0, 1}) {
    CHECK(map->at({-4, j}) == KnownCell::kWall);
    CHECK(map->at({-3, j}) == KnownCell::kWall);
    CHECK(map->at({-2, j}) == KnownCell::kFree);
    CHECK(map->at({-1, j}) == KnownCell::kFree);
  }
  CHECK(map->at({-4, 3}) == KnownCell::kUnknown);
  CHECK(map->at({-1, 3}) == KnownCell::kFree);
  CHECK(map->at({-5, 0}) == KnownCell::kUnknown);
}

TEST_CASE("a map of up to 500 m a side is read, whatever its cells, and a larger one refused") {
  const auto row_of = [](std::size_t pixels, const std::string& resolution) {
    return map_of("P5 " + std::to_string(pixels) + " 1 255\n" + std::string(pixels, '\xFE'),
                  "resolution: " + resolution + "\norigin: [0.05, 0.05, 0.0]\n");
  };
  CHECK(row_of(3111, "0.045")->at({1399, 0}) == KnownCell::kFree);
  CHECK(row_of(4999, "0.1")->at({4999, 0}) == KnownCell::kFree);
  CHECK(row_of(49'000, "0.01")->at({4899, 0}) == KnownCell::kFree);
  CHECK_THROWS_WITH(row_of(5100, "0.1"), Catch::Contains("more than 500 m a side"));
}

TEST_CASE("a map that is turned lies where its origin says") {
  // A row of three cells of 0.1 m that runs up the y axis: free, free, wall.
  const auto map = map_of(std::string("P5\n3 1\n255\n") + '\xFE' + '\xFE' + '\x00',
                          "resolution: 0.1\norigin: [1.0, 2.0, 1.5707963267948966]\n" + kThresholds);
  CHECK(map->at({9, 20}) == KnownCell::kFree);
  CHECK(map->at({9, 22}) == KnownCell::kWall);
}

TEST_CASE("a scan is found on the map, wherever it was taken and however turned") {
  const std::pair<const char*, Pose2> places[] = {
      {"map4", {3.0, 4.0, 0.3}}, {"map4", {13.0, 13.0, -2.0}}, {"map2", {12.0, 12.0, 2.0}}, {"map3", {4.0, 9.0, 1.0}}};
  for (const auto& [map, pose] : places) {
    INFO(map << " " << pose.x << " " << pose.y << " " << pose.heading);
    const Pose2 found = located(map, pose);
    CHECK(distance(found.position(), pose.position()) < 0.1);
    CHECK(std::fabs(wrap_angle(found.heading - pose.heading)) < 0.03);
  }
}

TEST_CASE("points behind a wall do not count: they fit best half a turn off, where the laser would see through walls") {
  const Pose2 pose{18.34, 16.93, -0.06};
  CHECK(distance(located("map1", pose).position(), pose.position()) < 0.15);
}

TEST_CASE("a place that has a twin is refused, and so is a scan of another place, both say what to give") {
  // The hall of crossing.yaml is the same turned by half a turn about (10, 7).
  const std::string twin = refusal_of([] { return located("crossing", {10.0, 7.0, 0.4}); });
  CHECK(twin.starts_with("robot.toml: the scan fits at ["));
  CHECK(holds(twin, "and nearly as well at ["));
  CHECK(holds(twin, "give start = [x, y, heading]"));
  const std::string said = refusal_of([] { return located("door", {5.0, 20.0, 0.0}, "map1"); });
  CHECK(said.starts_with("robot.toml: the scan fits nowhere on the map"));
}

TEST_CASE("a room of another building is not taken for one of the map's, though two of three points fit there") {
  for (const char* other : {"map2", "map3"}) {  // map1 and map4 refused it with 0.6, too
    CAPTURE(other);
    for (const Pose2& pose : {Pose2{2.0, 3.0, 1.2}, Pose2{3.0, 2.0, 0.0}, Pose2{10.0, 7.0, 0.4}}) {
      const LaserScan scan = scan_on("crossing", pose);
      CHECK_THROWS_AS(located_on(*own_map(other), scan, p3dx().laser, "robot.toml: "), StartupError);
    }
  }
}

// Two minutes, so outside the suite: robot_tests "[places]". It prints the figures of
// docs/tutorial/first-real-robot.md.
TEST_CASE("places drawn at random are found on their own map or refused", "[.][places]") {
  sim::Random random(GENERATE(78U, 79U), sim::Purpose::kPlacement);
  Tally own, other;
  for (const auto& [floor, size] : kFloors) {
    for (int k = 0; k < 5;) {
      const Pose2 pose{random.uniform(1.0, size.x - 1.0), random.uniform(1.0, size.y - 1.0), random.uniform(-kPi, kPi)};
      const auto scan = scan_if_free(floor, pose);
      if (!scan) continue;
      ++k;
      own.add(floor, *scan, pose);
      for (const char* map : {"map1", "map2", "map3", "map4"})
        if (map != floor) other.add(map, *scan, {-1e3, 0.0, 0.0});
    }
  }
  WARN("own map: " << own.right << " found, " << own.refused << " refused, " << own.wrong
                   << " wrong; other buildings: " << other.refused << " refused, " << other.wrong << " taken");
  CHECK(own.wrong == 0);
}
