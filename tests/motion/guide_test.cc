// The guide: nearest surfaces, and the time to the goal.
#include <cmath>
#include <cstring>

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
  for (const auto& [half, passes] : {std::pair{0.30, true}, {0.12, false}}) {
    test::Guided g;
    g.wall({2.05, -4.0}, {2.05, 1.05 - half}).wall({2.05, 1.05 + half}, {2.05, 6.0});
    const Guide& guide = g.towards({0.0, 1.0}, {4.0, 1.0});
    CHECK((guide.time_to_go(0.0F, 1.0F) < 20.0F) == passes);
  }
}

TEST_CASE("a mover that was mapped is no wall; one that has stood for long is walked round where there is room") {
  test::Guided g;
  g.wall({1.8, -0.2}, {2.2, -0.2}).wall({1.8, 0.2}, {2.2, 0.2}).wall({1.8, -0.2}, {1.8, 0.2});
  const float walled = g.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F);
  g.movers = {{.centre_in_map = {2.0, 0.0}, .radius_m = 0.3, .lasting = false}};
  const float masked = g.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F);
  g.movers[0].lasting = true;
  const float lasting = g.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F);
  CHECK(masked == Approx(4.0 / 0.6).margin(0.2));
  CHECK(walled > masked + 0.2F);
  CHECK(lasting > masked + 0.2F);
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

TEST_CASE("a goal outside the window draws towards it; one walled in has no way") {
  test::Guided far;
  const Guide& out = far.towards({0.0, 0.0}, {200.0, 0.0});
  CHECK(out.time_to_go(1.0F, 0.0F) < out.time_to_go(0.0F, 0.0F) - 1.0F);
  test::Guided boxed;
  boxed.wall({3.0, -1.0}, {5.0, -1.0})
      .wall({3.0, 1.0}, {5.0, 1.0})
      .wall({3.0, -1.0}, {3.0, 1.0})
      .wall({5.0, -1.0}, {5.0, 1.0});
  CHECK(boxed.towards({0.0, 0.0}, {4.0, 0.0}).time_to_go(0.0F, 0.0F) == Guide::kNoWay_s);
}

TEST_CASE("the guide forgets what it was asked before") {
  test::Guided a, b;
  a.wall({2.0, -1.0}, {2.0, 1.0});
  b.wall({2.0, -1.0}, {2.0, 1.0});
  (void)a.towards({5.0, 5.0}, {-3.0, -3.0});
  const Guide& one = a.towards({0.0, 0.0}, {4.0, 0.0});
  const Guide& two = b.towards({0.0, 0.0}, {4.0, 0.0});
  const auto cells = static_cast<std::size_t>(one.side) * static_cast<std::size_t>(one.side);
  CHECK(std::memcmp(one.to_go_s, two.to_go_s, cells * sizeof(float)) == 0);
  CHECK(std::memcmp(one.surface, two.surface, cells * sizeof(Place)) == 0);
}
