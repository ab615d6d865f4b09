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

}  // namespace

// The test fails at present: the robot forces a mover in 10 of 30 scenes, and 3 are allowed; with a body that ends
// 0.23 m behind the axle, not 0.30 m, in 4. In scene 08 a walker comes from behind, outside the laser's field of view.
// The baseline planners force a mover in 15 or 16 scenes and collide in 3 to 13 (docs/explanation/results.md).
TEST_CASE("in thirty scenes of failed runs the robot collides with nobody, forces at most three movers and drives on",
          "[long]") {
  const std::vector<std::string> names = scenes();
  REQUIRE(names.size() == 30);
  int forced = 0;
  double driven_m = 0.0;
  for (const std::string& name : names) {
    SimulatedDrive drive(std::filesystem::relative(JAYWALK_MOMENTS, JAYWALK_SCENARIOS).string() + "/" + name, 1);
    drive.drive(kScene_s, [&](const TickRecord&) {
      driven_m += std::fabs(drive.truth().twist.v_mps) * to_seconds(drive.setup().tick());
      return false;
    });
    CAPTURE(name);
    CHECK(drive.truth().contacts_caused == 0);
    forced += drive.truth().forced_movers > 0 ? 1 : 0;
  }
  CHECK(forced <= 3);
  CHECK(driven_m > 60.0);  // measured: 78 m in 240 s
}
