#include <memory>

#include "planner/tracking/scene.h"
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

/// After turns on the spot, number `first` to `last`, that all had this range.
void turn(SelfMask& mask, int first, int last, float range) {
  for (int k = first; k <= last; ++k) mask.learn(one_beam(range), {3.0, 1.0, 0.2 * k});
}

std::unique_ptr<SelfMask> after_turns(int count, float range) {
  auto mask = std::make_unique<SelfMask>(Pose2{});
  turn(*mask, 1, count, range);
  return mask;
}

}  // namespace

TEST_CASE("a range that stays under five turns on the spot is the robot's own") {
  const auto mask = after_turns(4, 0.7F);
  CHECK_FALSE(mask->on_robot(0, 0.7));  // seen first, agreed three times
  turn(*mask, 5, 5, 0.71F);
  CHECK(mask->on_robot(0, 0.7));
}

TEST_CASE("who stands before the robot's own mast, or is seen beside it, is not the robot's own") {
  const auto mask = after_turns(50, 0.7F);
  CHECK(mask->on_robot(0, 0.74));
  CHECK_FALSE(mask->on_robot(0, 0.6));
  CHECK_FALSE(mask->on_robot(0, 3.0));
}

TEST_CASE("a beam that has never measured anything at four headings is blocked, one that found nothing is not") {
  const auto mask = std::make_unique<SelfMask>(Pose2{});
  turn(*mask, 1, 3, 0.0F);
  CHECK_FALSE(mask->blocked(0));
  turn(*mask, 4, 4, 0.0F);
  CHECK(mask->blocked(0));
  turn(*mask, 5, 5, 20.0F);  // beyond its reach
  CHECK_FALSE(mask->blocked(0));
  turn(*mask, 6, 12, 0.0F);
  CHECK_FALSE(mask->blocked(0));
}

TEST_CASE("a wall driven along without turning is not the robot's own") {
  const auto mask = std::make_unique<SelfMask>(Pose2{});
  for (int k = 0; k < 1000; ++k) mask->learn(one_beam(0.7F), {0.1 * k, 0.0, 0.0});
  CHECK_FALSE(mask->on_robot(0, 0.7));
}

/// After driving round the origin, to the left of its way and 0.8 m off, looking along `beam_rad`.
std::unique_ptr<SelfMask> after_driving_round(double beam_rad, float range) {
  auto mask = std::make_unique<SelfMask>(Pose2{});
  LaserScan scan = one_beam(range);
  scan.first_angle_rad = static_cast<float>(beam_rad);
  for (int k = 0; k < 1000; ++k) {
    const Vec2 from_middle = direction(0.02 * k - 0.5 * kPi) * 0.8;
    mask->learn(scan, {from_middle.x, from_middle.y, wrap_angle(0.02 * k)});
  }
  return mask;
}

TEST_CASE("somebody whom the robot drives round is not its own, a mast on its other side is") {
  CHECK_FALSE(after_driving_round(0.5 * kPi, 0.55F)->on_robot(0, 0.55));
  CHECK(after_driving_round(-0.5 * kPi, 0.3F)->on_robot(0, 0.3));
}

TEST_CASE("what is farther than a metre is never the robot's own") {
  CHECK_FALSE(after_turns(100, 1.2F)->on_robot(0, 1.2));
}

TEST_CASE("what was taken off the robot is forgotten") {
  const auto mask = after_turns(99, 0.7F);
  REQUIRE(mask->on_robot(0, 0.7));
  turn(*mask, 100, 116, 3.0F);  // 20 - 17 = 3
  CHECK_FALSE(mask->on_robot(0, 0.7));
}

TEST_CASE("what stands before a robot that sways is not its own: it is at the same two headings again and again") {
  const auto mask = std::make_unique<SelfMask>(Pose2{});
  for (int k = 0; k < 100; ++k) mask->learn(one_beam(0.7F), {3.0, 1.0, k % 2 == 0 ? 0.5 : 0.74});
  CHECK_FALSE(mask->on_robot(0, 0.7));
}
