#include "planner/tracking/target.h"

#include <algorithm>
#include <memory>

#include "planner/tracking/occlusion.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("when the list is full the farthest from the robot goes") {
  const auto targets = std::make_unique<Targets>();
  for (std::uint32_t k = 1; k <= kMaxTracks; ++k) {
    admit(*targets, born_at({static_cast<double>(k), 0.0}, 0.1, 0.25, time_from_seconds(0.0), k), {0.0, 0.0});
  }
  REQUIRE(targets->full());
  const auto has = [&](std::uint32_t id) {
    for (const Target& target : *targets) {
      if (target.estimate.track.id == id) return true;
    }
    return false;
  };

  admit(*targets, born_at({2.5, 0.0}, 0.1, 0.25, time_from_seconds(1.0), 100), {0.0, 0.0});
  CHECK(has(100));
  CHECK_FALSE(has(64));  // it stood 64 m away

  admit(*targets, born_at({200.0, 0.0}, 0.1, 0.25, time_from_seconds(2.0), 101), {0.0, 0.0});
  CHECK_FALSE(has(101));  // the newcomer was the farthest itself
  CHECK(has(63));
  CHECK(targets->size() == kMaxTracks);
}

TEST_CASE("when the list is full what stands where walls stand goes first, however near") {
  const auto targets = std::make_unique<Targets>();
  const auto at = [](double x, std::uint32_t id, bool on_wall) {
    Target target = born_at({x, 0.0}, 0.1, 0.25, time_from_seconds(0.0), id);
    target.appearance.on_wall = on_wall;
    return target;
  };
  for (std::uint32_t k = 1; k <= kMaxTracks; ++k) admit(*targets, at(k, k, k <= 2), {0.0, 0.0});
  const auto has = [&](std::uint32_t id) {
    return std::any_of(targets->begin(), targets->end(),
                       [&](const Target& target) { return target.estimate.track.id == id; });
  };
  admit(*targets, at(200.0, 100, false), {0.0, 0.0});
  CHECK(has(100));
  CHECK(has(64));
  CHECK_FALSE(has(2));  // of the two pillars the one farther off
  admit(*targets, at(1.5, 101, true), {0.0, 0.0});
  CHECK_FALSE(has(101));  // a pillar drives no pillar out that is nearer
  admit(*targets, at(201.0, 102, false), {0.0, 0.0});
  CHECK_FALSE(has(1));
  admit(*targets, at(0.5, 103, true), {0.0, 0.0});
  CHECK_FALSE(has(103));  // nor anybody else
  CHECK(targets->size() == kMaxTracks);
}

TEST_CASE("a target that was elsewhere all the time has gone no farther by that") {
  Target target = born_at({1.0, 0.0}, 0.01, 0.25, time_from_seconds(0.0), 1);
  const Vec2 by{0.1, -0.2};
  move_all(target.estimate, target.onset, by);
  CHECK(distance(target.estimate.track.position_in_map, {1.1, -0.2}) < 1e-12);
  CHECK(distance(target.onset.anchor_in_map, {1.1, -0.2}) < 1e-12);
  target.estimate.filter.predict(target.estimate.track, 0.0);  // the models say the same
  CHECK(distance(target.estimate.track.position_in_map, {1.1, -0.2}) < 1e-12);
  for (int k = 1; k < 5; ++k) target.onset.positions.add(time_from_seconds(0.1 * k), {Vec2{1.1 + 0.05 * k, -0.2}});
  CHECK(target.onset.positions.fit().length_m == Approx(0.2));  // 4 steps of 5 cm, and no hop before them
  CHECK(target.onset.positions.fit().explained == Approx(1.0));
}

TEST_CASE(
    "who was known for a fifth of a second is kept unseen for as long as who is not believed yet, and no longer") {
  Target target = born_at({2.0, 0.0}, 0.05, 0.25, time_from_seconds(0.0), 1);
  target.estimate.track.hits = 3;
  target.estimate.track.last_seen = time_from_seconds(0.2);
  CHECK_FALSE(is_gone(target.estimate.track, target.existence, time_from_seconds(0.75)));
  CHECK(is_gone(target.estimate.track, target.existence, time_from_seconds(0.85)));
  target.estimate.track.last_seen = time_from_seconds(9.0);  // known for long: two seconds
  CHECK_FALSE(is_gone(target.estimate.track, target.existence, time_from_seconds(10.9)));
  CHECK(is_gone(target.estimate.track, target.existence, time_from_seconds(11.1)));
}
