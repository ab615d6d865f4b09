// The paper's planner, and what the robot's has in common with it: window, start, goal, path.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "hal/types/errors.h"
#include "planner/mapping/window.h"
#include "tests/planner/one_plan.h"
#include "tests/planner/test_maps.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Least distance from the path to the middle of any wall cell, in metres.
double nearest_wall(const Path& path, const TestMap& map) {
  double best = 1e9;
  for (std::int32_t c = 0; c < map.side * map.side; ++c) {
    if (map.wall[static_cast<std::size_t>(c)] == 0) continue;
    const Vec2 middle{(c % map.side + 0.5) * 0.1, (c / map.side + 0.5) * 0.1};
    for (const Vec2& p : path) best = std::min(best, distance(p, middle));
  }
  return best;
}

}  // namespace

TEST_CASE("a plan leads from the robot to the goal round the walls, smoothly, with points 0.05 to 0.2 m apart") {
  const auto planner = planner_of(true);
  for (const TestMap& map : {open_room(), office(), clutter(21), clutter(22), speckle(23)}) {
    const EvidenceMap evidence = evidence_of(map);
    const Vec2 from{1.07, 1.04}, to{24.31, 24.28};
    const Plan& plan = plan_of(*planner, request_on(evidence, from, to));
    REQUIRE(plan.status == PlanStatus::kOk);
    CHECK(plan.certified);
    CHECK(plan.reach == 1.0F);
    CHECK(plan.path[0] == from);
    CHECK(plan.path.back() == to);
    CHECK(nearest_wall(plan.path, map) > 0.24);  // cells within 0.3 m are not free; a cell's half diagonal is 0.07
    double sharpest = 0.0;
    for (std::size_t k = 1; k < plan.path.size(); ++k) {
      const double step = distance(plan.path[k - 1], plan.path[k]);
      CHECK(step > 0.05);
      CHECK(step < 0.2);
      if (k < 2) continue;
      const Vec2 a = plan.path[k - 1] - plan.path[k - 2], b = plan.path[k] - plan.path[k - 1];
      sharpest = std::max(sharpest, std::fabs(jaywalk::atan2(cross(a, b), dot(a, b))));
    }
    CHECK(sharpest < 0.7);  // 40 degrees in 0.1 m; the raw path turns by 45 and 90
  }
}

TEST_CASE("corridors 1.5 m and 1 m wide are followed to the end") {
  // 1 m less 0.3 m on either side leaves four free cells.
  const auto planner = planner_of(true);
  for (const std::int32_t corridor : {15, 10}) {
    const TestMap map = serpentine(corridor);
    const EvidenceMap evidence = evidence_of(map);
    const double top = 0.1 * (256 - 1 - (254 - corridor) % (corridor + 2) - corridor / 2.0);
    const Plan& plan = plan_of(*planner, request_on(evidence, {1.07, 0.65}, {12.75, top}));
    REQUIRE(plan.status == PlanStatus::kOk);
    CHECK(plan.certified);
    CHECK(length_of(plan.path) > 24.0 * (254 / (corridor + 2) - 1));  // one passage of 24 m after the other
    CHECK(plan.path.back() == Vec2{12.75, top});
  }
}

TEST_CASE("collect answers with the last submission, and with none before the first") {
  const auto planner = planner_of(GENERATE(false, true));
  const EvidenceMap map = evidence_of(open_room());
  CHECK(planner->collect().status == PlanStatus::kNone);
  CHECK(planner->collect().sequence == 0);
  planner->submit(request_on(map, {5.0, 5.0}, {8.0, 5.0}));
  planner->submit(request_on(map, {5.0, 5.0}, {9.0, 5.0}));
  const Plan& plan = planner->collect();
  CHECK(plan.sequence == 2);
  CHECK(plan.stamp == time_from_seconds(1.0));
  CHECK(plan.path.back() == Vec2{9.0, 5.0});
  planner->submit(request_on(map, {5.0, 5.0}, {7.0, 5.0}));
  CHECK(plan.sequence == 2);  // what was collected stays until the next collect
  CHECK(planner->collect().sequence == 3);
}

TEST_CASE("the field view shows 0 at the goal, NaN in walls, infinity where the goal cannot be reached") {
  const auto planner = planner_of(true);
  TestMap map = open_room();
  const EvidenceMap evidence = evidence_of(map.frame(100, 160));
  REQUIRE(plan_of(*planner, request_on(evidence, {2.0, 2.0}, {23.0, 23.0})).status == PlanStatus::kOk);
  const FieldView view = planner->view_field();
  CHECK(view.width == 256);
  const auto psi = [&](Vec2 p) {
    const std::int32_t i = static_cast<std::int32_t>(std::floor(p.x / 0.1)) - view.low.i;
    const std::int32_t j = static_cast<std::int32_t>(std::floor(p.y / 0.1)) - view.low.j;
    return view.psi[static_cast<std::size_t>(j * view.width + i)];
  };
  CHECK(psi({23.05, 23.05}) == 0.0F);
  CHECK(psi({2.05, 2.05}) > 1.0F);
  CHECK(std::isnan(psi({10.15, 13.05})));
  CHECK(std::isinf(psi({13.05, 13.05})));
}

TEST_CASE(
    "by a wall start and the paper's goal are moved to the nearest free cell, deep in it a robot is blocked and a goal "
    "has no path") {
  const bool is_paper = GENERATE(false, true);
  const auto planner = planner_of(is_paper);
  TestMap map = open_room();
  map.box(100, 100, 140, 140);
  const EvidenceMap evidence = evidence_of(map);
  const Plan& near_wall = plan_of(*planner, request_on(evidence, {9.9, 12.0}, {2.0, 12.0}));
  REQUIRE(near_wall.status == PlanStatus::kOk);
  CHECK(near_wall.path[0] == Vec2{9.9, 12.0});
  CHECK(plan_of(*planner, request_on(evidence, {12.0, 12.0}, {2.0, 12.0})).status == PlanStatus::kRobotBlocked);
  CHECK(planner->collect().path.empty());
  CHECK(plan_of(*planner, request_on(evidence, {2.0, 12.0}, {12.0, 12.0})).status == PlanStatus::kNoPath);
  if (!is_paper) return;
  const Plan& plan = plan_of(*planner, request_on(evidence, {2.0, 12.0}, {9.9, 12.0}));
  REQUIRE(plan.status == PlanStatus::kOk);
  CHECK(distance(plan.path.back(), {9.9, 12.0}) < 0.5);
}

TEST_CASE("an enclosed goal has no path, and no old one is passed off as new") {
  const auto planner = planner_of(true);
  TestMap map = open_room();
  const EvidenceMap before = evidence_of(map);
  const EvidenceMap after = evidence_of(map.frame(180, 220));
  CHECK(plan_of(*planner, request_on(before, {2.0, 2.0}, {20.0, 20.0})).status == PlanStatus::kOk);
  const Plan& plan = plan_of(*planner, request_on(after, {2.0, 2.0}, {20.0, 20.0}));
  CHECK(plan.status == PlanStatus::kNoPath);
  CHECK(plan.path.empty());
  CHECK_FALSE(plan.certified);
}

TEST_CASE("a pose, goal or speed that is no number is a bad request, and the next good one works") {
  const auto planner = planner_of(GENERATE(false, true));
  const EvidenceMap map = evidence_of(open_room());
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  CHECK(plan_of(*planner, request_on(map, {nan, 2.0}, {20.0, 20.0})).status == PlanStatus::kBadRequest);
  CHECK(plan_of(*planner, request_on(map, {2.0, 2.0}, {20.0, inf})).status == PlanStatus::kBadRequest);
  PlanRequest request = request_on(map, {2.0, 2.0}, {20.0, 20.0});
  request.map_from_robot.heading = nan;
  CHECK(plan_of(*planner, request).status == PlanStatus::kBadRequest);
  CHECK(plan_of(*planner, request_on(map, {2.0, 2.0}, {20.0, 20.0})).status == PlanStatus::kOk);
}

TEST_CASE("enormous but finite goals do no harm, nor do movers and standers that are no numbers or beyond reason") {
  const auto planner = planner_of(true);
  const EvidenceMap map(256, 0.1, {0.0, 0.0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Track> tracks{walker({1e200, -1e200}, {1e200, 0.0}), walker({1.0, nan}, {0.0, 0.0})};
  PlanRequest request = request_on(map, {0.0, 0.0}, {1e300, -1e300});
  request.moving = tracks;
  const std::vector<StandingPedestrian> standing{
      {{1e200, -1e200}, 0.25}, {{nan, 0.0}, 0.25}, {{0.0, 0.0}, nan}, {{3.0, 0.0}, 1e9}};
  request.standing = standing;
  const Plan& plan = plan_of(*planner, request);
  CHECK(plan.status == PlanStatus::kOk);
  CHECK(plan.predictions.empty());
}

TEST_CASE("without a map all is free") {
  const auto planner = planner_of(true);
  const EvidenceMap unused(64, 0.1, {0.0, 0.0});
  PlanRequest request = request_on(unused, {0.0, 0.0}, {5.0, 3.0});
  request.still = nullptr;
  const Plan& plan = plan_of(*planner, request);
  REQUIRE(plan.status == PlanStatus::kOk);
  CHECK(length_of(plan.path) < 1.05 * std::sqrt(34.0));
}

TEST_CASE("a goal outside the window is approached by its border, and a robot at its goal has a path of its own") {
  const bool is_paper = GENERATE(false, true);
  const auto planner = planner_of(is_paper);
  const EvidenceMap map(1024, 0.1, {0.0, 0.0});
  const Plan& plan = plan_of(*planner, request_on(map, {0.0, 0.0}, {60.0, 0.0}));
  REQUIRE(plan.status == PlanStatus::kOk);
  CHECK(plan.path.back().x > 15.0);
  CHECK(std::fabs(plan.path.back().y) < (is_paper ? 0.2 : 0.5));
  const Plan& there = plan_of(*planner, request_on(map, {3.0, 3.0}, {3.0, 3.0}));
  CHECK(there.status == PlanStatus::kOk);
  CHECK(there.path.back() == Vec2{3.0, 3.0});
}

TEST_CASE("a way round outside the window is found after a second: the window doubles") {
  // A wall 31 m long across the 25.6 m window between start and goal; its ends are outside.
  EvidenceMap map(1024, 0.1, {12.8, 12.8});
  for (std::int32_t j = -20; j < 290; ++j) map.add({128, j}, EvidenceMap::kMax), map.add({129, j}, EvidenceMap::kMax);
  const auto planner = planner_of(GENERATE(false, true), 512);
  const PlanRequest request = request_on(map, {8.0, 12.8}, {17.6, 12.8});
  for (int k = 0; k < field::kPatience; ++k) CHECK(plan_of(*planner, request).status == PlanStatus::kNoPath);
  const Plan& plan = plan_of(*planner, request);
  CHECK(plan.status == PlanStatus::kOk);
  CHECK(planner->view_field().width == 512);
  CHECK(length_of(plan.path) > 28.0);
}

TEST_CASE("a robot walled in with no way out keeps its window: a bigger one would not help") {
  const EvidenceMap evidence = evidence_of(open_room().frame(20, 80));
  const auto planner = planner_of(GENERATE(false, true), 512);
  for (int k = 0; k < 2 * field::kPatience; ++k) {
    CHECK(plan_of(*planner, request_on(evidence, {5.0, 5.0}, {20.0, 20.0})).status == PlanStatus::kNoPath);
  }
  CHECK(planner->view_field().width == 256);
}

TEST_CASE("configurations that make no sense are refused") {
  const auto refused = [](const auto& change) {
    paper::PaperConfig config;
    change(config);
    CHECK_THROWS_AS(paper::make_cpu_paper_planner(config), StartupError);
    return config;
  };
  refused([](auto& config) { config.side_cells = 300; });
  refused([](auto& config) { config.inflation_m = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& config) { config.horizon_cap_s = 0.0; });
  refused([](auto& config) { config.cell_m = 0.0; });
  const PlannerConfig small = refused([](auto& config) { config.max_side_cells = 128; });
  CHECK_THROWS_AS(make_cpu_planner(small), StartupError);
}

TEST_CASE("every status has a name of its own") {
  CHECK(std::string(name_of(PlanStatus::kOk)) == "ok");
  CHECK(std::string(name_of(PlanStatus::kRobotBlocked)) == "robot_blocked");
  CHECK(std::string(name_of(static_cast<PlanStatus>(99))) == "unknown");
}
