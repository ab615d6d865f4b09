#include "planner/tracking/bodies.h"

#include <algorithm>
#include <memory>

#include "planner/tracking/absence.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("when the list is full the farthest from the robot goes") {
  const auto bodies = std::make_unique<Bodies>();
  for (std::uint32_t k = 1; k <= kMaxTracks; ++k) {
    admit(*bodies, born_at({static_cast<double>(k), 0.0}, 0.1, 0.25, time_from_seconds(0.0), k), {0.0, 0.0});
  }
  REQUIRE(bodies->full());
  const auto has = [&](std::uint32_t id) {
    for (const Body& body : *bodies) {
      if (body.track.id == id) return true;
    }
    return false;
  };

  admit(*bodies, born_at({2.5, 0.0}, 0.1, 0.25, time_from_seconds(1.0), 100), {0.0, 0.0});
  CHECK(has(100));
  CHECK_FALSE(has(64));  // it stood 64 m away

  admit(*bodies, born_at({200.0, 0.0}, 0.1, 0.25, time_from_seconds(2.0), 101), {0.0, 0.0});
  CHECK_FALSE(has(101));  // the newcomer was the farthest itself
  CHECK(has(63));
  CHECK(bodies->size() == kMaxTracks);
}

TEST_CASE("when the list is full what stands where walls stand goes first, however near") {
  const auto bodies = std::make_unique<Bodies>();
  const auto at = [](double x, std::uint32_t id, bool on_wall) {
    Body body = born_at({x, 0.0}, 0.1, 0.25, time_from_seconds(0.0), id);
    body.on_wall = on_wall;
    return body;
  };
  for (std::uint32_t k = 1; k <= kMaxTracks; ++k) admit(*bodies, at(k, k, k <= 2), {0.0, 0.0});
  const auto has = [&](std::uint32_t id) {
    return std::any_of(bodies->begin(), bodies->end(), [&](const Body& body) { return body.track.id == id; });
  };
  admit(*bodies, at(200.0, 100, false), {0.0, 0.0});
  CHECK(has(100));
  CHECK(has(64));
  CHECK_FALSE(has(2));  // of the two pillars the one farther off
  admit(*bodies, at(1.5, 101, true), {0.0, 0.0});
  CHECK_FALSE(has(101));  // a pillar drives no pillar out that is nearer
  admit(*bodies, at(201.0, 102, false), {0.0, 0.0});
  CHECK_FALSE(has(1));
  admit(*bodies, at(0.5, 103, true), {0.0, 0.0});
  CHECK_FALSE(has(103));  // nor anybody else
  CHECK(bodies->size() == kMaxTracks);
}

TEST_CASE("a body that was elsewhere all the time has gone no farther by that") {
  Body body = born_at({1.0, 0.0}, 0.01, 0.25, time_from_seconds(0.0), 1);
  const Vec2 by{0.1, -0.2};
  move_all(body, by);
  CHECK(distance(body.track.position_in_map, {1.1, -0.2}) < 1e-12);
  CHECK(distance(body.anchor_in_map, {1.1, -0.2}) < 1e-12);
  body.models.predict(body.track, 0.0);  // the models say the same
  CHECK(distance(body.track.position_in_map, {1.1, -0.2}) < 1e-12);
  for (int k = 1; k < 5; ++k) body.path.add(time_from_seconds(0.1 * k), {Vec2{1.1 + 0.05 * k, -0.2}});
  CHECK(body.path.fit().length_m == Approx(0.2));  // 4 steps of 5 cm, and no hop before them
  CHECK(body.path.fit().explained == Approx(1.0));
}

TEST_CASE(
    "who was known for a fifth of a second is kept unseen for as long as who is not believed yet, and no longer") {
  Body body = born_at({2.0, 0.0}, 0.05, 0.25, time_from_seconds(0.0), 1);
  body.track.hits = 3;
  body.track.last_seen = time_from_seconds(0.2);
  CHECK_FALSE(gone(body, time_from_seconds(0.75)));
  CHECK(gone(body, time_from_seconds(0.85)));
  body.track.last_seen = time_from_seconds(9.0);  // known for long: two seconds
  CHECK_FALSE(gone(body, time_from_seconds(10.9)));
  CHECK(gone(body, time_from_seconds(11.1)));
}
