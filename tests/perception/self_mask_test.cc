#include "planner/perception/self_mask.h"

#include <memory>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

LaserScan one_beam(float range) {
  LaserScan scan;
  scan.beam_count = 1;
  scan.range_min_m = 0.05F;
  scan.range_max_m = 10.0F;
  scan.range_m[0] = range;
  return scan;
}

}  // namespace

TEST_CASE("a range that stays under five turns is the robot's own") {
  const auto mask = std::make_unique<SelfMask>();
  for (int k = 1; k <= 4; ++k) mask->learn(one_beam(0.7F), 0.2 * k);
  CHECK_FALSE(mask->on_robot(0));  // seen first, agreed three times
  mask->learn(one_beam(0.71F), 1.0);
  CHECK(mask->on_robot(0));
}

TEST_CASE("a wall driven along without turning is not the robot's own") {
  const auto mask = std::make_unique<SelfMask>();
  for (int k = 0; k < 1000; ++k) mask->learn(one_beam(0.7F), 0.0);
  CHECK_FALSE(mask->on_robot(0));
}

TEST_CASE("what is farther than a metre is never the robot's own") {
  const auto mask = std::make_unique<SelfMask>();
  for (int k = 1; k < 100; ++k) mask->learn(one_beam(1.2F), 0.2 * k);
  CHECK_FALSE(mask->on_robot(0));
}

TEST_CASE("what was taken off the robot is forgotten") {
  const auto mask = std::make_unique<SelfMask>();
  for (int k = 1; k < 100; ++k) mask->learn(one_beam(0.7F), 0.2 * k);
  REQUIRE(mask->on_robot(0));
  for (int k = 100; k < 117; ++k) mask->learn(one_beam(3.0F), 0.2 * k);  // 20 - 17 = 3
  CHECK_FALSE(mask->on_robot(0));
}
