#include "planner/tracking/target.h"

#include <algorithm>
#include <memory>

#include "planner/tracking/occlusion.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

Target at(double x, std::uint32_t id, bool on_wall = false) {
  Target target = born_at({x, 0.0}, 0.1, 0.25, time_from_seconds(0.0), id);
  target.appearance.on_wall = on_wall;
  return target;
}

/// As many as fit, 1 m from one another; the first of them stand where walls stand.
std::unique_ptr<Targets> full_list(std::uint32_t on_walls) {
  auto targets = std::make_unique<Targets>();
  for (std::uint32_t k = 1; k <= kMaxTracks; ++k) admit(*targets, at(k, k, k <= on_walls), {0.0, 0.0});
  REQUIRE(targets->full());
  return targets;
}

bool has(const Targets& targets, std::uint32_t id) {
  return std::ranges::any_of(targets, [&](const Target& target) { return target.estimate.track.id == id; });
}

Observation seen_at(double x, double std_m) {
  Observation seen;
  seen.position_in_map = {x, 0.0};
  seen.std_m = std_m;
  seen.radius_m = 0.25;
  return seen;
}

Observation two_legs_at(double x) {
  Observation seen = seen_at(x, 0.07);
  seen.two_legs = true;
  return seen;
}

/// One who walks along x at 1.2 m/s, and whose middle has been where it should be for three seconds.
Target walker_seen_well() {
  Target target = born_at({0.0, 0.0}, 0.07, 0.25, time_from_seconds(0.0), 1);
  for (int k = 1; k <= 45; ++k) {
    const Time now = time_from_seconds(k / 15.0);
    target.estimate.filter.predict(target.estimate.track, 1.0 / 15.0);
    update_with(target, two_legs_at(1.2 * k / 15.0), {}, now);
  }
  return target;
}

/// Then one leg alone is seen, which stays where it is for a third of a second: his velocity after that.
double speed_after_a_standing_leg(bool said_to_be_one) {
  Target target = walker_seen_well();
  for (int k = 46; k <= 50; ++k) {
    target.estimate.filter.predict(target.estimate.track, 1.0 / 15.0);
    Observation seen = seen_at(3.6, 0.21);
    seen.lone_leg = said_to_be_one;
    update_with(target, seen, {}, time_from_seconds(k / 15.0));
  }
  return target.estimate.track.velocity_in_map.x;
}

}  // namespace

TEST_CASE("when the list is full the farthest from the robot goes") {
  const auto targets = full_list(0);
  admit(*targets, at(2.5, 100), {0.0, 0.0});
  CHECK(has(*targets, 100));
  CHECK_FALSE(has(*targets, 64));  // it stood 64 m away
  admit(*targets, at(200.0, 101), {0.0, 0.0});
  CHECK_FALSE(has(*targets, 101));  // the newcomer was the farthest itself
  CHECK(has(*targets, 63));
  CHECK(targets->size() == kMaxTracks);
}

TEST_CASE("when the list is full what stands where walls stand goes first, however near") {
  const auto targets = full_list(2);
  admit(*targets, at(200.0, 100), {0.0, 0.0});
  CHECK(has(*targets, 100));
  CHECK(has(*targets, 64));
  CHECK_FALSE(has(*targets, 2));  // of the two pillars the one farther off
  admit(*targets, at(1.5, 101, true), {0.0, 0.0});
  CHECK_FALSE(has(*targets, 101));  // a pillar drives no pillar out that is nearer
  admit(*targets, at(201.0, 102), {0.0, 0.0});
  CHECK_FALSE(has(*targets, 1));
  admit(*targets, at(0.5, 103, true), {0.0, 0.0});
  CHECK_FALSE(has(*targets, 103));  // nor anybody else
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

TEST_CASE("whose middle is seen well does not stop when one leg alone is seen to stand") {
  CHECK(walker_seen_well().appearance.noise < 0.2);
  CHECK(speed_after_a_standing_leg(true) > 0.6);
  CHECK(speed_after_a_standing_leg(false) < 0.3);  // as if it were as sure as both legs
}

TEST_CASE("who shows two legs has no arc, and who no longer does may have one again") {
  Target target = walker_seen_well();
  CHECK(target.appearance.on_legs());
  Observation wide = seen_at(3.6, 0.01);
  wide.arc_m = 0.25;
  target.appearance.arc_m = 0.25;
  update_with(target, two_legs_at(3.6), {}, time_from_seconds(3.1));
  CHECK(target.appearance.arc_m == 0.0);
  for (int k = 0; k < 20; ++k) update_with(target, wide, {}, time_from_seconds(3.2 + k / 15.0));
  CHECK_FALSE(target.appearance.on_legs());
  CHECK(target.appearance.arc_m == Approx(0.25));
}
