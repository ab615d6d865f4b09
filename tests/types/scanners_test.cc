#include <vector>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("what there is of each scanner is the first's and then the others', in order") {
  const int first = 7;
  const std::vector<int> others{8, 9};
  const OfEach<int> all(first, others);
  CHECK(all.size() == 3);
  CHECK(all[0] == 7);
  CHECK(all[2] == 9);
  std::vector<int> met;
  for (const int& each : all) met.push_back(each);
  CHECK(met == std::vector{7, 8, 9});
  CHECK(OfEach<int>(first).size() == 1);
  CHECK(OfEach<int>(std::span<const int>(others))[1] == 9);
}

TEST_CASE("a scanner is called by its side of the body, a second one there by its number, and one alone by nothing") {
  RobotModel model = wheelchair();
  CHECK(scanner_name(model, 0).empty());
  LaserModel other = model.laser;
  const auto add = [&](const Pose2& mount) {
    other.robot_from_laser = mount;
    REQUIRE(model.other_lasers.push_back(other));
  };
  add({-0.32, -0.30, -2.4});
  add({0.2, 0.32, 1.6});
  add({0.70, 0.30, 0.8});
  CHECK(scanner_name(model, 0) == "front");
  CHECK(scanner_name(model, 1) == "rear");
  CHECK(scanner_name(model, 2) == "left");
  CHECK(scanner_name(model, 3) == "front2");
  CHECK_FALSE(model.other_lasers.push_back(other));
}
