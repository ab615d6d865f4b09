// Scenes of eight seconds cut out of failed runs: a mover had to turn for the robot there. The robot begins each
// scene at rest, and the movers repeat their recorded walks without reacting to it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kScene_s = 8.0;

std::vector<std::string> scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(JAYWALK_MOMENTS))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

struct Scene {
  std::uint32_t forced = 0, touched = 0;
  double driven_m = 0.0;
};

Scene drive_through(const std::string& name) {
  SimulatedDrive drive(std::filesystem::relative(JAYWALK_MOMENTS, JAYWALK_SCENARIOS).string() + "/" + name, 1);
  Scene scene;
  drive.drive(kScene_s, [&](const TickRecord&) {
    scene.driven_m += std::fabs(drive.truth().twist.v_mps) * to_seconds(drive.setup().tick());
    return false;
  });
  scene.forced = drive.truth().forced_movers;
  scene.touched = drive.truth().contacts_caused;
  return scene;
}

}  // namespace

// The test fails at present: the robot forces a mover in 10 of 30 scenes, and 3 are allowed. It touches no mover. In
// scene 08 a walker comes from behind at 1.2 m/s, outside the laser's field of view, and passes the robot closely; with
// a price of kWound = 2 the walker touched the robot. With a body 0.46 m long and 0.38 m wide the robot forced a mover
// in 4 scenes and drove 70 m. The P3-DX's rear end, 0.30 m behind the axle, made the difference; its width did not.
// Each scene runs differently after any change of the motion. The baseline planners force a mover in 15 or 16 scenes
// and collide in 3 to 13 (docs/explanation/results.md).
TEST_CASE("in thirty scenes of failed runs the robot collides with nobody, forces at most three movers and drives on",
          "[long]") {
  const std::vector<std::string> names = scenes();
  REQUIRE(names.size() == 30);
  int forced = 0;
  double driven_m = 0.0;
  for (const std::string& name : names) {
    const Scene scene = drive_through(name);
    CAPTURE(name);
    CHECK(scene.touched == 0);
    forced += scene.forced > 0 ? 1 : 0;
    driven_m += scene.driven_m;
  }
  CHECK(forced <= 3);
  CHECK(driven_m > 60.0);  // measured: 78 m in 240 s
}
