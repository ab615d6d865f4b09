// A controller that knows the map before its first scan.
#include <cmath>

#include "hal/maps/wall_map.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// The scenario's own map, whose cells are 0.1 m wide and begin at the origin.
std::shared_ptr<const KnownMap> known(const std::string& map) {
  const sim::Raster raster = sim::load_raster(std::string(JAYWALK_SCENARIOS) + "/../maps/" + map + ".yaml");
  KnownMap known{raster.cell_m, {0, 0}, raster.width, raster.height, {}};
  for (const std::uint8_t solid : raster.solid) known.cells.push_back(solid != 0 ? KnownCell::kWall : KnownCell::kFree);
  return std::make_shared<const KnownMap>(std::move(known));
}

/// What a run of a minute and a half saw.
std::shared_ptr<const KnownMap> seen_before() {
  SimulatedDrive drive("map4_00", 2);
  drive.drive(90.0);
  const EvidenceMap& still = drive.loop().tracker().still();
  KnownMap seen{still.cell_m(), {-5, -5}, 266, 266, {}};
  for (std::int32_t j = -5; j < 261; ++j) {
    for (std::int32_t i = -5; i < 261; ++i)
      seen.cells.push_back(still.occupied({i, j})    ? KnownCell::kWall
                           : still.seen_free({i, j}) ? KnownCell::kFree
                                                     : KnownCell::kUnknown);
  }
  return std::make_shared<const KnownMap>(std::move(seen));
}

/// Seconds to the goal by the plan after a second, and the largest error of the estimated pose in `drive_s`.
struct Knows {
  float to_go_s = 0.0F;
  double error_m = 0.0;
};

Knows drive(const std::shared_ptr<const KnownMap>& map, double drive_s) {
  SimulatedDrive drive("map4_00", 1, {}, PlanMode::kFull, "", [&](ControlSetup& setup) { setup.known_map = map; });
  Knows knows;
  drive.drive(1.0);
  const Pose2 here = drive.truth().map_from_robot;
  knows.to_go_s = drive.loop().plan().guide.time_to_go(static_cast<float>(here.x), static_cast<float>(here.y));
  drive.drive(drive_s, [&](const TickRecord& t) {
    knows.error_m = std::max(knows.error_m, drive.off_m(t));
    return false;
  });
  CHECK(drive.truth().contacts == 0);
  return knows;
}

}  // namespace

TEST_CASE("a robot that knows the map plans the whole way at once, and is placed on it by its scans") {
  const Knows with = drive(known("map4"), 60.0), without = drive(nullptr, 60.0);
  // 49.3 m of shortest path at 0.6 m/s are 82 s; without the map the way leads straight through what was not seen.
  CHECK(with.to_go_s > 82.0F);
  CHECK(without.to_go_s < with.to_go_s - 15.0F);
  CHECK(with.error_m < 0.04);  // drawn walls are half a cell off where the laser finds them at first
  CHECK(without.error_m < 0.02);
}

TEST_CASE("a robot that knows what an earlier run saw is placed on it by its scans") {
  const Knows with = drive(seen_before(), 60.0);
  CHECK(with.to_go_s > 70.0F);  // not all of the way was seen
  CHECK(with.error_m < 0.02);
}

TEST_CASE("a known map is part of a setup's text, text that holds no map is refused") {
  ControlSetup setup;
  setup.known_map = known("door");
  const ControlSetup back = setup_from_text(to_text(setup), "here");
  REQUIRE(back.known_map != nullptr);
  CHECK(back.known_map->cells == setup.known_map->cells);
  CHECK(back.known_map->width == 86);
  CHECK(to_text(back) == to_text(setup));
  std::string text = to_text(setup);
  const std::size_t cells = text.find("\"cells\":\"") + 9;
  CHECK_THROWS(setup_from_text(text.substr(0, cells) + "9999999w" + text.substr(cells), "here"));
  CHECK_THROWS(setup_from_text(text.substr(0, cells) + "3x" + text.substr(cells), "here"));
}
