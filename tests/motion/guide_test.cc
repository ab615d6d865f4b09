// The guide: nearest surfaces, and the time to the goal.
#include <cmath>

#include "planner/cost_to_go/guide_field.h"
#include "tests/motion/guided.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("the guide knows how far surfaces are, to better than a cell") {
  test::Guided g;
  g.wall({3.03, -4.0}, {3.03, 6.0});
  const Guide& guide = g.towards({0.0, 0.0}, {5.0, 0.0});
  CHECK(guide.distance(2.0F, 0.5F) == Approx(1.03).margin(0.02));
  CHECK(guide.distance(2.77F, 1.23F) == Approx(0.26).margin(0.02));
  CHECK(guide.distance(3.53F, 1.0F) == Approx(0.50).margin(0.02));
  CHECK(guide.distance(-3.0F, 0.0F) == Guide::kFar_m);
  CHECK(guide.distance(1e9F, 0.0F) == Guide::kFar_m);  // outside
}

TEST_CASE("open ground: the time to go is the distance over the speed, within 3 per cent in all directions") {
  test::Guided g;
  for (const double rad : {0.0, 0.3, 0.6, 0.9, 1.3, 2.0, 3.1, -1.1}) {
    const Vec2 goal = direction(rad) * 3.0;
    const Guide& guide = g.towards({0.0, 0.0}, goal);
    CHECK(guide.time_to_go(0.0F, 0.0F) == Approx(3.0 / 0.6).epsilon(0.03).margin(0.15));
  }
}

TEST_CASE("a wall is walked round, and the way keeps its distance") {
  test::Guided g;
  g.wall({2.0, -4.0}, {2.0, 3.0});
  const Guide& guide = g.towards({0.0, 0.0}, {4.0, 0.0});
  const double round = 2.0 * std::sqrt(4.0 + 9.0) / 0.6;  // touching the wall's end
  CHECK(guide.time_to_go(0.0F, 0.0F) > static_cast<float>(round));
  CHECK(guide.time_to_go(0.0F, 0.0F) < static_cast<float>(1.4 * round));
  CHECK(guide.time_to_go(2.05F, 0.0F) == Guide::kNoWay_s);  // in the wall
}

TEST_CASE("a gap that the inscribed circle fits is a way, a narrower one is none") {
  const auto [half, passes] = GENERATE(std::pair{0.30, true}, std::pair{0.12, false});
  test::Guided g;
  g.wall({2.05, -4.0}, {2.05, 1.05 - half}).wall({2.05, 1.05 + half}, {2.05, 6.0});
  const Guide& guide = g.towards({0.0, 1.0}, {4.0, 1.0});
  CHECK((guide.time_to_go(0.0F, 1.0F) < 20.0F) == passes);
}

TEST_CASE("a mover that was mapped is no wall, one that has stood for long is walked round where there is room") {
  test::Guided g;
  g.wall({1.8, -0.2}, {2.2, -0.2}).wall({1.8, 0.2}, {2.2, 0.2}).wall({1.8, -0.2}, {1.8, 0.2});
  const float walled = g.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F);
  g.movers = {{.centre_in_map = {2.0, 0.0}, .radius_m = 0.3}};
  const float masked = g.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F);
  g.standing = {{.position_in_map = {2.0, 0.0}, .radius_m = 0.3}};
  const float stands = g.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F);
  CHECK(masked == Approx(4.0 / 0.6).margin(0.2));
  CHECK(walled > masked + 0.2F);
  CHECK(stands > masked + 0.2F);
  // Seconds a metre on the straight way to the goal, by hand: threefold those of 0.6 m/s at a gap of half a metre to
  // the pedestrian, fivefold within 0.25 m.
  const Guide& beside = g.towards({0.0, 0.0}, {4.0, 0.0});
  const auto falls = [&](float x) { return beside.time_to_go(x, 0.0F) - beside.time_to_go(x + 0.2F, 0.0F); };
  CHECK(falls(3.0F) == Approx(3.0F * 0.2F / 0.6F).epsilon(0.1));
  CHECK(falls(2.4F) == Approx(5.0F * 0.2F / 0.6F).epsilon(0.1));
}

TEST_CASE("what was never seen near the robot is no way while another is not much longer") {
  test::Guided g;
  for (int j = -40; j < 60; ++j) {
    for (int i = 3; i < 12; ++i) {
      if (j < 12) g.forget({i, j});  // ahead, up to y = 1.2
    }
  }
  const Guide& guide = g.towards({0.0, 0.0}, {2.0, 0.0});
  CHECK_FALSE(guide.through_unseen);
  CHECK(guide.time_to_go(0.0F, 0.0F) > 1.2F * 2.0F / 0.6F);
  CHECK(guide.is_unseen(0.75F, 0.0F));
  CHECK_FALSE(guide.is_unseen(0.05F, 0.0F));
  for (int j = 12; j < 60; ++j) {
    for (int i = 3; i < 12; ++i) g.forget({i, j});
  }
  CHECK(g.towards({0.0, 0.0}, {2.0, 0.0}).through_unseen);  // now there is none
}

TEST_CASE("a goal outside the window draws towards it, one walled in has no way") {
  test::Guided far;
  const Guide& out = far.towards({0.0, 0.0}, {200.0, 0.0});
  CHECK(out.time_to_go(1.0F, 0.0F) < out.time_to_go(0.0F, 0.0F) - 1.0F);
  test::Guided boxed;
  boxed.wall({3.0, -1.0}, {5.0, -1.0}).wall({3.0, 1.0}, {5.0, 1.0});
  boxed.wall({3.0, -1.0}, {3.0, 1.0}).wall({5.0, -1.0}, {5.0, 1.0});
  CHECK(boxed.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F) == Guide::kNoWay_s);
}

namespace {

/// 100 by 40 m, free but for a wall along y = 0 and one at x = 50 m that leaves 5 m open at the top.
std::shared_ptr<const KnownMap> hall_with_a_wall() {
  KnownMap hall{0.1, {0, 0}, 1000, 400, std::vector<KnownCell>(400'000, KnownCell::kFree)};
  for (std::int32_t i = 0; i < 1000; ++i) hall.mark({i, 0}, KnownCell::kWall);
  for (std::int32_t j = 0; j < 350; ++j) hall.mark({500, j}, KnownCell::kWall);
  return std::make_shared<const KnownMap>(std::move(hall));
}

constexpr Time kFirst{std::chrono::seconds(1)};

}  // namespace

TEST_CASE("the way beyond the window goes round a wall of the known map") {
  field::FarGuide far(0.1, hall_with_a_wall());
  far.settle(kFirst, nullptr, {10.0, 5.0}, {90.0, 5.0});
  const double straight_up = 30.0, along = 40.0;  // from (10, 5) by (50, 35) to (90, 5): 50 m and 50 m
  CHECK(far.to_go_m({10.0, 5.0}) == Approx(2.0 * std::hypot(straight_up, along)).epsilon(0.06));
  CHECK(far.to_go_m({45.0, 5.0}) > 60.0);
  CHECK(std::isinf(far.to_go_m({50.05, 5.0})));  // in the wall
  CHECK(far.has_way_near({50.05, 5.0}));
}

TEST_CASE("the way beyond the window remembers what has left the evidence map") {
  field::FarGuide far(0.1, nullptr);
  EvidenceMap still(128, 0.1, {10.0, 0.0});  // 12.8 m
  for (std::int32_t j = -60; j < 60; ++j) still.add({100, j}, 20);
  far.settle(kFirst, &still, {0.0, 0.0}, {60.0, 0.0});
  const double seen = far.to_go_m({5.0, 0.0});
  CHECK(seen > 1.02 * far.to_go_m({5.0, 12.0}));  // round the wall's end
  still.roll_to({-40.0, 0.0});
  far.settle(kFirst + std::chrono::seconds(2), &still, {0.0, 0.0}, {60.0, 0.0});
  CHECK(far.to_go_m({5.0, 0.0}) == seen);
  still.roll_to({10.0, 0.0});
  for (std::int32_t j = -60; j < 60; ++j) still.add({100, j}, -20);  // it has gone
  far.settle(kFirst + std::chrono::seconds(4), &still, {0.0, 0.0}, {60.0, 0.0});
  CHECK(far.to_go_m({5.0, 0.0}) < seen);
}

TEST_CASE("where few cells have changed, the far way is what it is from nothing") {
  field::FarGuide repaired(0.1, hall_with_a_wall()), anew(0.1, hall_with_a_wall());
  EvidenceMap still(512, 0.1, {50.0, 20.0});
  repaired.settle(kFirst, nullptr, {10.0, 5.0}, {90.0, 5.0});
  for (std::int32_t j = 360; j < 390; ++j) still.add({500, j}, 20);
  for (std::int32_t j = 100; j < 120; ++j)
    for (std::int32_t i = 496; i < 504; ++i) still.add({i, j}, -20);
  repaired.settle(kFirst + std::chrono::seconds(2), &still, {10.0, 5.0}, {90.0, 5.0});
  anew.settle(kFirst, &still, {10.0, 5.0}, {90.0, 5.0});
  for (double x = 1.0; x < 99.0; x += 3.7)
    for (double y = 1.0; y < 39.0; y += 2.9) CHECK(repaired.to_go_m({x, y}) == anew.to_go_m({x, y}));
}

TEST_CASE("the known map enters where the evidence map rolls on, and leaves what was seen") {
  const auto known = hall_with_a_wall();
  EvidenceMap map(128, 0.1, {44.0, 10.0});
  enter(*known, map, std::nullopt);
  CHECK(map.occupied({500, 100}));
  CHECK(map.seen_free({450, 100}));
  CHECK_FALSE(map.seen_free({520, 100}));  // outside
  map.add({450, 100}, EvidenceMap::kMax - EvidenceMap::kMin);
  map.forget({500, 100});
  const CellIndex before = map.low();
  map.roll_to({48.5, 10.0});
  enter(*known, map, before);
  CHECK(map.seen_free({520, 100}));
  CHECK(map.occupied({450, 100}));
  CHECK(map.evidence({500, 100}) == 0);
}
