#include "planner/tracking/scene.h"

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

/// After turns on the spot, number `first` to `last`, that all had this range.
void turn(SelfMask& mask, int first, int last, float range) {
  for (int k = first; k <= last; ++k) mask.learn(one_beam(range), {3.0, 1.0, 0.2 * k});
}

std::unique_ptr<SelfMask> after_turns(int count, float range) {
  auto mask = std::make_unique<SelfMask>(Pose2{});
  turn(*mask, 1, count, range);
  return mask;
}

/// One body at (2, 0), known since 0 s and seen whole by point 0 of two; point 1 lies beside it, 0.3 m from its middle.
struct Seen {
  Seen() {
    Target target = born_at({2.0, 0.0}, 0.02, 0.25, time_from_seconds(0.0), 7);
    target.estimate.track.hits = 5;
    target.appearance.whole = true;
    target.appearance.arc_m = 0.25;
    (void)targets.push_back(target);
    Detection detection;
    detection.segment = {0, 0};
    detection.track_id = 7;
    (void)detections.push_back(detection);
    in_map.position[0] = {1.75, 0.0};
    in_map.position[1] = {2.0, 0.3};
  }
  Target& target() { return targets[0]; }
  std::array<Becomes, 2> at(double now_s) {
    decide_entries(targets, detections, {in_map.position.data(), 2}, still, time_from_seconds(now_s), entries);
    return {entries[0], entries[1]};
  }

  EvidenceMap still{64, 0.1, {}};
  Targets targets;
  Detections detections;
  PointsInMap in_map;
  Entries entries{};
};

using Pair = std::array<Becomes, 2>;

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

TEST_CASE("what is seen under one heading, or under two again and again, is not the robot's own") {
  const auto along = std::make_unique<SelfMask>(Pose2{}), swaying = std::make_unique<SelfMask>(Pose2{});
  for (int k = 0; k < 1000; ++k) along->learn(one_beam(0.7F), {0.1 * k, 0.0, 0.0});  // a wall
  for (int k = 0; k < 100; ++k) swaying->learn(one_beam(0.7F), {3.0, 1.0, k % 2 == 0 ? 0.5 : 0.74});
  CHECK_FALSE(along->on_robot(0, 0.7));
  CHECK_FALSE(swaying->on_robot(0, 0.7));
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

TEST_CASE("who may stand on unknown ground is no wall for three seconds") {
  const auto seen = std::make_unique<Seen>();
  CHECK(seen->at(2.9) == Pair{Becomes::kObstacle, Becomes::kWall});
  CHECK(seen->at(3.0) == Pair{Becomes::kWall, Becomes::kWall});
  seen->detections[0].on_wall = true;  // a pillar that comes into view again
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
}

TEST_CASE("posts and what is seen in part are walls at once") {
  const auto seen = std::make_unique<Seen>();
  seen->target().appearance.arc_m = 0.1;
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
  seen->target().appearance.arc_m = 0.25;
  seen->target().appearance.whole = false;
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
  seen->detections[0].track_id = 8;  // nobody's
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
}

TEST_CASE("who moves or came to free ground and has not settled leaves nothing in the map") {
  const auto seen = std::make_unique<Seen>();
  seen->detections[0].in_free_space = true;
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kWall});
  seen->target().existence.settled = true;
  CHECK(seen->at(9.0)[0] == Becomes::kWall);
  seen->target().estimate.track.moving = true;
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kNothing});
  for (int k = 0; k < 3; ++k) seen->still.add_hit({2.0, 0.3}, 10);  // a known obstacle stays one
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kWall});
}
