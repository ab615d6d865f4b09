// Plans among people who walk, and who stand.
#include <algorithm>
#include <vector>

#include "tests/planner/one_plan.h"
#include "tests/planner/test_maps.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr Vec2 kDoor{12.8, 12.8};

/// A wall across the room, and one door in it, 1.2 m wide.
EvidenceMap room_with_door() {
  TestMap map = open_room();
  map.box(127, 0, 129, 256), map.box(127, 122, 129, 134, 0);
  return evidence_of(map);
}

double nearest_to(Vec2 place, const Path& path) {
  double nearest = 1e9;
  for (const Vec2& p : path) nearest = std::min(nearest, distance(p, place));
  return nearest;
}

}  // namespace

TEST_CASE("the path keeps clear of where a head-on walker will be, and reports it") {
  const auto planner = planner_of(true);
  const EvidenceMap map(512, 0.1, {0.0, 0.0});
  // 5.7 m ahead at the robot's own speed: r = 3 m, 5 s, it is then 2.7 m ahead.
  const std::vector<Track> tracks{walker({5.7, 0.0}, {-0.6, 0.0})};
  PlanRequest request = request_on(map, {0.0, 0.0}, {10.0, 0.0});
  request.moving = tracks;
  const Plan& plan = plan_of(*planner, request);
  REQUIRE(plan.status == PlanStatus::kOk);
  REQUIRE(plan.predictions.size() == 1);
  CHECK(plan.predictions[0].track_id == 7);
  CHECK(nearest_to({2.7, 0.0}, plan.path) > 0.8);  // body 0.27, safety 0.3, inflation 0.3, less half a cell
  CHECK(plan.predictions[0].position_in_map.x == Approx(2.7).epsilon(0.03));
}

TEST_CASE("a door that a walker blocks, or somebody who stands, stops the paper's robot however far it is") {
  const bool stands = GENERATE(false, true);
  const EvidenceMap evidence = room_with_door();
  const std::vector<Track> tracks{walker(kDoor, {0.0, 0.0})};
  const std::vector<StandingPedestrian> standing{{kDoor, 0.25}};
  const auto planner = planner_of(true);
  PlanRequest request = request_on(evidence, {2.0, 12.8}, {23.0, 12.8});
  CHECK(plan_of(*planner, request).status == PlanStatus::kOk);
  if (stands) request.standing = standing;
  if (!stands) request.moving = tracks;
  CHECK(plan_of(*planner, request).status == PlanStatus::kNoPath);
  CHECK(planner->collect().predictions.size() == (stands ? 0 : 1));
}

TEST_CASE("the path keeps clear of a standing pedestrian by its radius and the inflation") {
  const auto planner = planner_of(true);
  const EvidenceMap map(512, 0.1, {0.0, 0.0});
  const std::vector<StandingPedestrian> standing{{{5.0, 0.0}, 0.25}};
  PlanRequest request = request_on(map, {0.0, 0.0}, {10.0, 0.0});
  request.standing = standing;
  const Plan& plan = plan_of(*planner, request);
  REQUIRE(plan.status == PlanStatus::kOk);
  // Radius 0.25, inflation 0.3, less half a cell and what rounding to cells takes.
  CHECK(nearest_to({5.0, 0.0}, plan.path) > 0.48);
}

TEST_CASE("a goal that a pedestrian or a mover stands on is approached") {
  const bool moves = GENERATE(false, true);
  const auto planner = planner_of(true);
  const EvidenceMap map(512, 0.1, {0.0, 0.0});
  const std::vector<StandingPedestrian> standing{{{8.0, 0.0}, 0.25}};
  const std::vector<Track> tracks{walker({8.0, 0.0}, {0.0, 0.0})};
  PlanRequest request = request_on(map, {0.0, 0.0}, {8.0, 0.0});
  if (moves) request.moving = tracks;
  if (!moves) request.standing = standing;
  const Plan& plan = plan_of(*planner, request);
  REQUIRE(plan.status == PlanStatus::kOk);
  CHECK(distance(plan.path.back(), {8.0, 0.0}) < (moves ? 2.0 : 0.8));
  CHECK(distance(plan.path.back(), {8.0, 0.0}) > (moves ? 0.5 : 0.45));
}
