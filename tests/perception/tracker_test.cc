#include "planner/tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>

#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// A disc goes off at `velocity`, m/s: the scans until something is called moving, or 60.
int scans_until_seen_to_move(Watch& watch, const Disc& disc, Vec2 velocity) {
  int scans = 0;
  for (; watch.tracker.moving().empty() && scans < 60; ++scans) {
    watch.see(with({{disc.centre + velocity * (scans / 15.0), disc.radius_m}}));
  }
  return scans;
}

/// Two shins of somebody who walks across, `way_m` after he set out from `from`, at 0.8 m/s: steps of 0.56 m, of which
/// shins do two thirds to and fro (hal/sim/world.h).
Room with_walker(Vec2 from, double way_m) {
  const double steps = way_m / 0.56, of_two = steps - 2.0 * std::floor(0.5 * steps);
  const double ahead = 0.187 * (of_two < 1.0 ? 1.0 - 2.0 * of_two : 2.0 * of_two - 3.0);
  const Vec2 left{from.x + 0.1, from.y + way_m + ahead}, right{from.x - 0.1, from.y + way_m - ahead};
  return rectangle(20.0, 20.0, {{left, 0.06}, {right, 0.06}});
}

}  // namespace

TEST_CASE("a walking disc is tracked with its place, velocity and size and leaves no trail") {
  SettledWatch watch;
  for (int k = 0; k < 60; ++k) watch.see(with({{{2.0, -2.0 + 0.06 * k}, 0.27}}));  // 0.9 m/s to the left
  const Track& track = only_mover(watch.tracker);
  CHECK(distance(track.position_in_map, {2.0, 1.54}) < 0.12);
  CHECK(distance(track.velocity_in_map, {0.0, 0.9}) < 0.15);
  CHECK(track.radius_m == Approx(0.27).margin(0.06));
  CHECK(track.stamp == time_from_seconds(89 / 15.0));
  CHECK(occupied_cells(watch.tracker.still(), {15, -35}, {25, 30}) == 0);
}

TEST_CASE("who comes straight on is known to move within a second, a trolley of 1.4 m within 0.6 s and its width") {
  SettledWatch comes, trolley;
  CHECK(scans_until_seen_to_move(comes, {{3.0, -1.0}, 0.25}, {-0.75, 0.0}) <= 15);
  CHECK(scans_until_seen_to_move(trolley, {{3.0, -1.0}, 0.7}, {0.0, 0.5}) <= 9);
  CHECK(only_mover(trolley.tracker).radius_m == Approx(0.7).margin(0.06));
}

TEST_CASE("a slow walker who was there from the first scan on is no wall that walks along") {
  Watch watch;
  // 15 cm takes 0.4 s, cells behind must be seen free.
  CHECK(scans_until_seen_to_move(watch, {{3.0, -1.0}, 0.27}, {0.0, 0.4}) <= 25);
}

TEST_CASE("who stood when first seen is still the same one when he sets out, be he a wall by then or not") {
  const auto [scans, is_wall, seen_to_move_within] =
      GENERATE(table<int, bool, int>({{40, false, 12}, {300, true, 9}}));  // 2.7 s and 20 s, 0.8 s and 0.6 s
  CAPTURE(scans);
  Watch watch;
  for (int k = 0; k < scans; ++k) watch.see(with({{{3.0, -1.0}, 0.27}}));
  REQUIRE(watch.tracker.tracks().size() == 1);
  const std::uint32_t name = watch.tracker.tracks()[0].id;
  const EvidenceMap& still = watch.tracker.still();
  const CellIndex his_side = still.cell_at({2.73, -1.0});
  CHECK((is_wall ? still.stands(his_side) : still.occupied(his_side)));  // he is an obstacle all the same
  CHECK(scans_until_seen_to_move(watch, {{3.0, -1.0}, 0.27}, {0.0, 0.4}) <= seen_to_move_within);
  CHECK(only_mover(watch.tracker).id == name);
}

TEST_CASE("who walks past where a scanner that looks all round begins its turn is one and the same") {
  for (const double step_deg : {0.5, -0.5}) {
    Watch watch;
    watch.fan = {.beams = 720, .first_rad = 0.0, .step_rad = step_deg * kPi / 180.0};
    watch.look_round();
    std::uint32_t name = 0;
    for (int k = 0; k < 60; ++k) {
      const double y = -1.5 + 0.05 * k;  // 0.75 m/s from right to left, straight ahead halfway
      watch.see(with({{{2.0, y}, 0.27}}));
      if (k < 15) continue;
      const Track& track = only_mover(watch.tracker);
      name = name == 0 ? track.id : name;
      CHECK(track.id == name);
      CHECK(distance(track.position_in_map, {2.0, y}) < 0.1);
      CHECK(watch.tracker.tracks().size() == 1);
    }
  }
}

TEST_CASE("a robot that turns in a room sees nothing move") {
  Watch watch;
  Room room = with({{{2.0, 1.0}, 0.1}, {{-1.5, 2.0}, 0.25}, {{1.0, -2.0}, 0.05}});
  for (int k = 0; k < 200; ++k) watch.see(room, {0.0, 0.0, wrap_angle(0.07 * k)});  // 1 rad/s
  CHECK(watch.most_moving == 0);
}

TEST_CASE("posts that are seen in turns are not one who walks") {
  SettledWatch watch;
  const double at[] = {-0.75, -0.25, 0.25, 0.75};  // 0.5 m apart, each returns beams for 0.4 s: a walk of 1.25 m/s
  for (int k = 0; k < 48; ++k) watch.see(with({{{2.0, at[k / 6 % 4]}, 0.05}}));
  CHECK(watch.most_moving == 0);
}

TEST_CASE("whoever stops becomes still and enters the map, and moves again when setting out") {
  SettledWatch watch;
  for (int k = 0; k < 45; ++k) watch.see(with({{{2.0, -2.0 + 0.06 * k}, 0.27}}));
  REQUIRE(watch.tracker.moving().size() == 1);
  const Disc standing{{2.0, 0.64}, 0.27};
  for (int k = 0; k < 75; ++k) watch.see(with({standing}));  // 5 s
  CHECK(watch.tracker.moving().empty());
  const EvidenceMap& still = watch.tracker.still();
  CHECK(still.occupied(still.cell_at({1.75, 0.57})));  // the side that the robot sees
  for (int k = 0; k < 45; ++k) watch.see(with({{{2.0, 0.64 - 0.06 * k}, 0.27}}));
  CHECK(watch.tracker.moving().size() == 1);
}

TEST_CASE("a clock set back by less than a second loses nobody") {
  for (const double back_s : {0.2, 0.5, 0.9}) {
    SettledWatch watch;
    const auto see = [&](int k, double stamp_s) {
      LaserScan scan = scan_of(with({{{3.0, -2.0 + 0.08 * k}, 0.27}}), {}, ++watch.scan, kNoiseM);  // 1.2 m/s
      scan.stamp = time_from_seconds(stamp_s);
      watch.tracker.update(scan, {});
    };
    for (int k = 0; k < 25; ++k) see(k, 2.0 + k / 15.0);
    const std::uint32_t name = only_mover(watch.tracker).id;
    for (int k = 25; k < 45; ++k) {
      see(k, 2.0 + k / 15.0 - back_s);
      const Track& track = only_mover(watch.tracker);
      CHECK(track.id == name);
      CHECK(distance(track.position_in_map, {3.0, -2.0 + 0.08 * k}) < 0.15);
    }
    CHECK(norm(watch.tracker.moving()[0].velocity_in_map - Vec2{0.0, 1.2}) < 0.2);
  }
}

TEST_CASE("two that cross keep their names") {
  SettledWatch watch;
  const auto near_at = [](int k) { return Vec2{2.0, -2.0 + 0.05 * k}; };
  const auto far_at = [](int k) { return Vec2{3.2, 2.0 - 0.05 * k}; };
  std::uint32_t near_id = 0, far_id = 0;
  const auto id_at = [&](Vec2 p) {
    const Track* const track = track_near(watch.tracker.moving(), p, 0.3);
    return track == nullptr ? 0U : track->id;
  };
  for (int k = 0; k < 80; ++k) {
    watch.see(with({{near_at(k), 0.25}, {far_at(k), 0.25}}));
    if (k == 25) near_id = id_at(near_at(k)), far_id = id_at(far_at(k));
  }
  CHECK(near_id != 0);
  CHECK(far_id != 0);
  CHECK(id_at(near_at(79)) == near_id);  // the far one was hidden for a while in between
  CHECK(id_at(far_at(79)) == far_id);
}

TEST_CASE("two that walk all but touching are still two") {
  SettledWatch watch;
  // 1 cm between them for a second, and the left one a little behind the right one's edge: no beam passes through
  const auto aside = [](int k) { return 0.255 + 0.02 * std::max(0, std::abs(k - 37) - 7); };
  std::uint32_t left_id = 0, right_id = 0;
  for (int k = 0; k < 60; ++k) {
    const Vec2 left{1.0 + 0.05 * k, 0.5 + aside(k)}, right{1.0 + 0.05 * k, 0.5 - aside(k)};
    watch.see(with({{left, 0.25}, {right, 0.25}}));
    const std::span<const Track> tracks = watch.tracker.moving();
    if (k < 25) continue;
    REQUIRE(tracks.size() == 2);
    const std::size_t first = tracks[0].position_in_map.y > 0.5 ? 0 : 1;
    if (k == 25) left_id = tracks[first].id, right_id = tracks[1 - first].id;
    CHECK(tracks[first].id == left_id);
    CHECK(tracks[1 - first].id == right_id);
    CHECK(distance(tracks[first].position_in_map, left) < 0.05);
    CHECK(distance(tracks[1 - first].position_in_map, right) < 0.05);
  }
}

TEST_CASE("a pose that is not finite is refused") {
  SettledWatch watch;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  watch.tracker.update(scan_of(rectangle(12.0, 10.0), {}, ++watch.scan), {nan, 0.0, 0.0});
  CHECK(watch.tracker.tracks().empty());
}

TEST_CASE("somebody on two legs is known within two seconds, far off as well, and is one") {
  const double range_m = GENERATE(3.0, 6.0, 8.5);
  CAPTURE(range_m);
  Watch watch;
  for (int k = 0; k < 30; ++k) watch.see(rectangle(20.0, 20.0));
  int known_after = 0;
  std::uint32_t id = 0;
  for (int k = 0; k < 90; ++k) {
    watch.see(with_walker({range_m, -2.4}, 0.8 * k / 15.0));
    if (watch.tracker.moving().empty()) continue;
    const Track& track = watch.tracker.moving()[0];
    if (known_after == 0) known_after = k, id = track.id;
    CHECK(track.id == id);
    if (k < known_after + 15) continue;
    CHECK(distance(track.position_in_map, {range_m, -2.4 + 0.8 * k / 15.0}) < 0.25);
    CHECK(distance(track.velocity_in_map, {0.0, 0.8}) < 0.4);
  }
  CHECK(known_after > 0);
  CHECK(known_after < 30);
  CHECK(watch.most_moving == 1);
}
