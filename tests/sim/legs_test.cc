#include <algorithm>
#include <cmath>

#include "hal/sim/world.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

constexpr double kTick = 0.02, kHeading = 0.5;

MoverTruth at(double way_m, double speed_mps) {
  const Vec2 ahead = direction(kHeading);
  return {.id = 1, .position = ahead * way_m, .velocity = ahead * speed_mps, .heading = kHeading};
}

/// Left leg less right one, ahead and to the left of the walker.
Vec2 apart(const Legs& legs, const MoverTruth& walker) {
  const auto [left, right] = legs.of(walker);
  const Vec2 ahead = direction(walker.heading), between = left.centre - right.centre;
  return {dot(between, ahead), cross(ahead, between)};
}

}  // namespace

TEST_CASE("legs overtake each other as far and as often as people's do") {
  const double speed = GENERATE(0.4, 1.3);
  const double step_m = speed == 1.3 ? 0.712 : 0.395;  // sqrt(0.39 m s times the speed)
  Legs legs;
  double farthest = 0.0, before = 0.0;
  int overtakings = 0;
  for (int k = 0; k < 1000; ++k) {
    const MoverTruth walker = at(k * kTick * speed, speed);
    legs.walk(walker, kTick);
    const auto [left, right] = legs.of(walker);
    CHECK(distance((left.centre + right.centre) * 0.5, walker.position) < 1e-9);
    const Vec2 between = apart(legs, walker);
    CHECK(between.y == Approx(0.2));
    if (k > 100) farthest = std::max(farthest, between.x);
    if (k > 100 && before * between.x < 0.0) ++overtakings;
    before = between.x;
  }
  CHECK(farthest == Approx(2.0 / 3.0 * step_m).epsilon(0.05));
  CHECK(overtakings == Approx(18.0 * speed / step_m).margin(1.0));  // of 18 s, one a step
}

TEST_CASE("who stops puts his feet side by side") {
  Legs legs;
  for (int k = 0; k < 111; ++k) legs.walk(at(k * kTick * 1.3, 1.3), kTick);
  const MoverTruth standing = at(111 * kTick * 1.3, 0.0);
  CHECK(std::fabs(apart(legs, standing).x) > 0.1);
  for (int k = 0; k < 40; ++k) legs.walk(standing, kTick);
  CHECK(apart(legs, standing).x == Approx(0.0).margin(1e-9));
}

TEST_CASE("a laser sees the legs of who has them and touching goes by the disc") {
  Scenario scenario = in_room();
  scenario.wanderers = {{.count = 2}, {.count = 1, .legs = true}};
  World world(scenario, 1);
  for (int k = 0; k < 500; ++k) world.step();
  REQUIRE(world.truth().movers.size() == 3);
  REQUIRE(world.movers_seen().size() == 4);
  CHECK(world.movers_seen()[0].radius_m == 0.27);
  CHECK(world.movers_seen()[2].radius_m == 0.06);
  const MoverTruth& walker = world.truth().movers[2];
  CHECK(walker.radius_m == 0.27);
  const Vec2 middle = (world.movers_seen()[2].centre + world.movers_seen()[3].centre) * 0.5;
  CHECK(distance(middle, walker.position) < 1e-9);
}
