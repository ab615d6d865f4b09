#include <limits>

#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

OutsideFix fix_with(std::uint32_t k, double t_s, std::initializer_list<ObservedMover> movers) {
  OutsideFix fix;
  fix.stamp = time_from_seconds(t_s);
  fix.sequence = k;
  fix.mover_std_m = 0.05;
  for (const ObservedMover& mover : movers) REQUIRE(fix.movers.push_back(mover));
  return fix;
}

PerceptionConfig small() { return {.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}; }

}  // namespace

TEST_CASE("a given mover is moving from its first report and keeps one track for its name") {
  Tracker tracker(small());
  for (std::uint32_t k = 0; k < 20; ++k) {
    tracker.update_given(fix_with(k + 1, 0.2 * k, {{.id = 7, .position_in_map = {0.08 * k, 3.0}, .radius_m = 0.27}}));
    REQUIRE(tracker.moving().size() == 1);
  }
  const Track& track = only_mover(tracker);
  CHECK(track.id == 1);
  CHECK(track.radius_m == 0.27);
  CHECK(track.hits == 20);
  CHECK(track.velocity_in_map.x == Approx(0.4).margin(0.05));  // 0.08 m each 0.2 s
  CHECK(distance(track.position_in_map, {0.08 * 19, 3.0}) < 0.03);
}

TEST_CASE("the second report of a given mover is blended by hand") {
  Tracker tracker(small());
  tracker.update_given(fix_with(1, 0.0, {{.id = 7, .position_in_map = {0.0, 0.0}, .radius_m = 0.3}}));
  tracker.update_given(fix_with(2, 1.0, {{.id = 7, .position_in_map = {0.5, 0.0}, .radius_m = 0.3}}));
  // Born with pp = 0.0025, vv = 1; a second on, with q = 0.5^2: pp = 0.0025 + 1 + 0.0625 = 1.065,
  // pv = 1 + 0.125 = 1.125; S = 1.065 + 0.0025 = 1.0675: position 0.5 x 1.065 / 1.0675, velocity 0.5 x 1.125 / 1.0675.
  CHECK(tracker.moving()[0].position_in_map.x == Approx(0.5 * 1.065 / 1.0675));
  CHECK(tracker.moving()[0].velocity_in_map.x == Approx(0.5 * 1.125 / 1.0675));
}

TEST_CASE("a given mover that is no longer reported dies after a second") {
  Tracker tracker(small());
  tracker.update_given(fix_with(1, 0.0, {{.id = 7, .position_in_map = {2.0, 0.0}, .radius_m = 0.27}}));
  const Room room = rectangle(12.0, 10.0);
  for (std::uint32_t k = 1; k <= 15; ++k) tracker.update(scan_of(room, {}, k), {});  // to 14/15 s
  CHECK(tracker.moving().size() == 1);
  for (std::uint32_t k = 16; k <= 18; ++k) tracker.update(scan_of(room, {}, k), {});
  CHECK(tracker.tracks().empty());
}

TEST_CASE("movers whose place, size or noise is no number are passed over") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Tracker tracker(small());
  tracker.update_given(fix_with(1, 0.0,
                                {{.id = 1, .position_in_map = {nan, 0.0}, .radius_m = 0.27},
                                 {.id = 2, .position_in_map = {2.0, 1e300}, .radius_m = 0.27},
                                 {.id = 3, .position_in_map = {2.0, 0.0}, .radius_m = nan},
                                 {.id = 4, .position_in_map = {3.0, 0.0}, .radius_m = 0.27}}));
  REQUIRE(tracker.tracks().size() == 1);
  CHECK(tracker.tracks()[0].position_in_map.x == 3.0);
  OutsideFix noisy = fix_with(2, 0.1, {{.id = 5, .position_in_map = {4.0, 0.0}, .radius_m = 0.27}});
  noisy.mover_std_m = nan;
  tracker.update_given(noisy);
  CHECK(tracker.tracks().size() == 1);
}

TEST_CASE("beams that end on a given mover stay out of the map and make no track of their own") {
  Tracker tracker(small());
  Room room = rectangle(12.0, 10.0);
  for (std::uint32_t k = 1; k <= 45; ++k) {
    const Vec2 at{2.0, -1.0 + 0.02 * k};
    room.discs = {{at, 0.27}};
    tracker.update_given(fix_with(k, (k - 1) / 15.0, {{.id = 3, .position_in_map = at, .radius_m = 0.27}}));
    tracker.update(scan_of(room, {}, k), {});
  }
  CHECK(tracker.tracks().size() == 1);
  CHECK(occupied_cells(tracker.still(), {15, -20}, {25, 20}) == 0);
  CHECK(tracker.still().occupied(tracker.still().cell_at({5.99, 1.0})));
}

TEST_CASE("of more given movers than there are tracks the nearest are kept") {
  Tracker tracker(small());
  for (std::uint32_t batch = 0; batch < 2; ++batch) {
    OutsideFix fix = fix_with(batch + 1, 0.0, {});
    for (std::uint32_t k = 0; k < kMaxObservedMovers; ++k) {
      const std::uint32_t id = batch * 100 + k;
      REQUIRE(fix.movers.push_back({.id = id, .position_in_map = {2.0 * k + (1.0 - batch), 0.0}, .radius_m = 0.2}));
    }
    tracker.update_given(fix);
  }
  REQUIRE(tracker.tracks().size() == kMaxTracks);
  // 1, 3, 5 .. 127 m, then 0, 2, 4 .. 126 m: the 64 nearest of both lie at 0 to 63 m.
  for (const Track& track : tracker.tracks()) CHECK(track.position_in_map.x < 64.0);
}

TEST_CASE("a report that comes late is of where a given mover was, and not where it is") {
  Tracker tracker(small());
  const Room room = rectangle(12.0, 10.0);
  for (std::uint32_t k = 1; k <= 60; ++k) {
    tracker.update(scan_of(room, {}, k), {});
    const double then_s = (k - 1) / 15.0 - 0.3;
    if (k % 3 == 0)
      tracker.update_given(fix_with(k, then_s, {{.id = 7, .position_in_map = {1.2 * then_s, 3.0}, .radius_m = 0.27}}));
  }
  CHECK(only_mover(tracker).position_in_map.x == Approx(1.2 * 59 / 15.0).margin(0.03));
}

TEST_CASE("a second after the outside system's last word the laser finds movers by itself") {
  Tracker tracker(small());
  Room room = rectangle(12.0, 10.0);
  tracker.update_given(fix_with(1, 0.0, {}));
  for (std::uint32_t k = 1; k <= 60; ++k) {
    room.discs = {{{2.0, -2.0 + 0.06 * k}, 0.27}};
    tracker.update(scan_of(room, {}, k), {});
    if (k < 15) CHECK(tracker.tracks().empty());
  }
  CHECK(tracker.moving().size() == 1);
}
