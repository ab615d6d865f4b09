// Plans by the time to go, as what drives asks for: status, path and window.
#include <array>
#include <cmath>
#include <vector>

#include "tests/planner/one_plan.h"
#include "tests/planner/test_maps.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Whether cells of the view that are free join two places, by their eight neighbours.
bool are_joined(const FieldView& view, Vec2 from, Vec2 to) {
  const auto cell = [&view](Vec2 p) {
    return CellIndex{static_cast<std::int32_t>(std::floor(p.x / view.cell_m)) - view.low.i,
                     static_cast<std::int32_t>(std::floor(p.y / view.cell_m)) - view.low.j};
  };
  const auto at = [&view](CellIndex c) { return static_cast<std::size_t>(c.j * view.width + c.i); };
  std::vector<bool> seen(view.psi.size());
  std::vector<CellIndex> open{cell(from)};
  while (!open.empty()) {
    const CellIndex c = open.back();
    open.pop_back();
    const bool inside = c.i >= 0 && c.j >= 0 && c.i < view.width && c.j < view.height;
    if (!inside || seen[at(c)] || std::isnan(view.psi[at(c)])) continue;
    seen[at(c)] = true;
    for (const auto& [di, dj] : {CellIndex{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}})
      open.push_back({c.i + di, c.j + dj});
  }
  return seen[at(cell(to))];
}

}  // namespace

TEST_CASE("what drives knows neither potential nor marks, the paper's plan has both, and the same time to go") {
  const auto planner = planner_of(false), papers = planner_of(true);
  const EvidenceMap map = evidence_of(office());
  PlanRequest request = request_on(map, {1.07, 1.04}, {24.31, 24.28});
  const std::array walkers{walker({5.0, 5.0}, {0.4, 0.0})};
  request.moving = walkers;
  for (int round = 0; round < 2; ++round) {
    const Plan& plain = plan_of(*planner, request);
    CHECK(plain.status == PlanStatus::kOk);
    CHECK(plain.certified);
    CHECK(plain.cycles == 0);
    CHECK(plain.predictions.empty());
    CHECK(planner->view_field().of == FieldView::Of::kTimeToGo);
    const Plan& full = plan_of(*papers, request);
    CHECK(full.status == PlanStatus::kOk);
    CHECK(full.cycles > 0);
    CHECK(full.predictions.size() == 1);
    CHECK(full.guide.time_to_go(5.0F, 5.0F) == plain.guide.time_to_go(5.0F, 5.0F));
    CHECK(papers->view_field().of == FieldView::Of::kPotential);
  }
}

TEST_CASE("the path down the time to go leads from robot to goal, 0.2 m from walls, with points 0.1 m apart") {
  const auto planner = planner_of(false);
  for (const TestMap& map : {open_room(), office(), clutter(21), clutter(22), speckle(23)}) {
    const EvidenceMap evidence = evidence_of(map);
    const Vec2 from{1.07, 1.04}, to{24.31, 24.28};
    const Plan& plan = plan_of(*planner, request_on(evidence, from, to));
    REQUIRE(plan.status == PlanStatus::kOk);
    CHECK(plan.path[0] == from);
    CHECK(plan.path.back() == to);
    for (std::size_t k = 1; k < plan.path.size(); ++k) {
      CHECK(distance(plan.path[k - 1], plan.path[k]) < 0.1 + 1e-9);
      // Cells whose middle is 0.21 m from a surface are free, and the straight line between two is checked by cells.
      const Vec2 p = plan.path[k];
      CHECK(plan.guide.distance(static_cast<float>(p.x), static_cast<float>(p.y)) > 0.14F);
    }
  }
}

TEST_CASE("on open ground the path is straight within three per cent, whatever its direction") {
  const auto planner = planner_of(false);
  const EvidenceMap map(512, 0.1, {0.0, 0.0});
  for (const double rad : {0.0, 0.2, 0.5, 0.8, 1.3, 2.0, -2.9}) {
    const Vec2 to = direction(rad) * 8.0;
    CHECK(length_of(plan_of(*planner, request_on(map, {0.0, 0.0}, to)).path) < 1.03 * 8.0);
  }
}

TEST_CASE("there is a path exactly where free cells join robot and goal") {
  const auto planner = planner_of(false);
  int joined = 0, apart = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    TestMap map = clutter(seed, 250);
    const auto gap = static_cast<std::int32_t>(2 + seed % 4);  // cells
    for (std::int32_t k = 0; k < 256; k += 64) map.box(k, 100, k + 64 - gap, 102);
    map.box(4, 4, 24, 24, 0), map.box(232, 232, 252, 252, 0);
    const EvidenceMap evidence = evidence_of(map);
    const Vec2 from{1.45, 1.45}, to{24.15, 24.15};
    const Plan& plan = plan_of(*planner, request_on(evidence, from, to));
    CHECK(plan.certified);
    const bool has_way = are_joined(planner->view_field(), from, to);
    CHECK(plan.status == (has_way ? PlanStatus::kOk : PlanStatus::kNoPath));
    CHECK(plan.path.empty() != has_way);
    ++(has_way ? joined : apart);
  }
  CHECK(joined > 3);
  CHECK(apart > 3);
}

TEST_CASE("a body that was mapped and may leave is no wall on the way") {
  const auto planner = planner_of(false);
  TestMap map = open_room();
  map.box(0, 128, 256, 130);
  map.box(125, 128, 131, 130, 0);  // a door 0.6 m wide
  const EvidenceMap open = evidence_of(map);
  map.box(126, 128, 130, 130);  // and somebody in it
  const EvidenceMap closed = evidence_of(map);
  PlanRequest request = request_on(closed, {5.0, 5.0}, {20.0, 20.0});
  CHECK(plan_of(*planner, request_on(open, {5.0, 5.0}, {20.0, 20.0})).status == PlanStatus::kOk);
  CHECK(plan_of(*planner, request).status == PlanStatus::kNoPath);
  const std::array bodies{MoverDisc{{12.8, 12.9}, 0.27}};
  request.masked = bodies;
  CHECK(plan_of(*planner, request).status == PlanStatus::kOk);
}

TEST_CASE("a wall half a metre from an enclosed robot is no way through it") {
  const auto planner = planner_of(false);
  const EvidenceMap cage = evidence_of(open_room().frame(20, 80));
  // Beyond it there are cells with a way, within kStartRadius_m.
  CHECK(plan_of(*planner, request_on(cage, {7.3, 5.0}, {20.0, 5.0})).status == PlanStatus::kNoPath);
}
