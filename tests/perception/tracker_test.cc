#include "planner/perception/tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>

#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr double kNoiseM = 0.01;

struct Watch {
  Tracker tracker{{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}};
  std::uint32_t scan = 0;
  std::size_t most_moving = 0;
  Fan fan{};

  void see(const Room& room, const Pose2& robot = {}) {
    tracker.update(scan_of(room, robot, ++scan, kNoiseM, fan), robot);
    most_moving = std::max(most_moving, tracker.moving().size());
  }
  /// Somebody in the empty room who is dark all over: his beams return nothing.
  void see_dark(const Disc& disc) {
    Room room = rectangle(12.0, 10.0);
    const LaserScan empty = scan_of(room, {}, ++scan, kNoiseM, fan);
    room.discs = {disc};
    LaserScan seen = scan_of(room, {}, scan, kNoiseM, fan);
    for (std::size_t k = 0; k < seen.beam_count; ++k) {
      if (seen.range_m[k] != empty.range_m[k]) seen.range_m[k] = std::numeric_limits<float>::quiet_NaN();
    }
    tracker.update(seen, {});
  }
  /// Looks at an empty 12 m x 10 m room for two seconds.
  void look_round() {
    for (int k = 0; k < 30; ++k) see(rectangle(12.0, 10.0));
  }
};

Room with(std::initializer_list<Disc> discs) {
  Room room = rectangle(12.0, 10.0);
  room.discs = discs;
  return room;
}

/// A disc goes off at `velocity`, m/s: the scans until something is called moving, or 60.
int scans_until_seen_to_move(Watch& watch, const Disc& disc, Vec2 velocity) {
  int scans = 0;
  for (; watch.tracker.moving().empty() && scans < 60; ++scans) {
    watch.see(with({{disc.centre + velocity * (scans / 15.0), disc.radius_m}}));
  }
  return scans;
}

}  // namespace

TEST_CASE("an empty room is walls and free space and nothing moves") {
  Watch watch;
  watch.look_round();
  const EvidenceMap& still = watch.tracker.still();
  CHECK(still.occupied(still.cell_at({5.99, 1.0})));
  CHECK(still.seen_free(still.cell_at({3.0, 1.0})));
  CHECK(still.evidence(still.cell_at({7.0, 1.0})) == 0);
  CHECK(watch.most_moving == 0);
  CHECK(watch.tracker.tracks().empty());
}

TEST_CASE("a walking disc is tracked with its place, velocity and size and leaves no trail") {
  Watch watch;
  watch.look_round();
  for (int k = 0; k < 60; ++k) watch.see(with({{{2.0, -2.0 + 0.06 * k}, 0.27}}));  // 0.9 m/s to the left
  REQUIRE(watch.tracker.moving().size() == 1);
  const Track& track = watch.tracker.moving()[0];
  CHECK(distance(track.position_in_map, {2.0, 1.54}) < 0.12);
  CHECK(distance(track.velocity_in_map, {0.0, 0.9}) < 0.15);
  CHECK(track.radius_m == Approx(0.27).margin(0.06));
  CHECK(track.stamp == time_from_seconds(89 / 15.0));
  const EvidenceMap& still = watch.tracker.still();
  int marked = 0;
  for (int j = -35; j < 30; ++j) {
    for (int i = 15; i < 25; ++i) marked += still.occupied({i, j}) ? 1 : 0;
  }
  CHECK(marked == 0);
}

TEST_CASE("a walker is called moving within a second of setting out") {
  Watch watch;
  watch.look_round();
  CHECK(scans_until_seen_to_move(watch, {{3.0, -1.0}, 0.25}, {-0.75, 0.0}) <= 15);  // towards the robot
}

TEST_CASE("a slow walker who was there from the first scan on is no wall that walks along") {
  Watch watch;
  // 15 cm takes 0.4 s, cells behind must be seen free.
  CHECK(scans_until_seen_to_move(watch, {{3.0, -1.0}, 0.27}, {0.0, 0.4}) <= 25);
}

TEST_CASE("who stood when first seen is still the same one when he sets out") {
  Watch watch;
  for (int k = 0; k < 40; ++k) watch.see(with({{{3.0, -1.0}, 0.27}}));  // 2.7 s
  REQUIRE(watch.tracker.tracks().size() == 1);
  const std::uint32_t name = watch.tracker.tracks()[0].id;
  const EvidenceMap& still = watch.tracker.still();
  CHECK(still.occupied(still.cell_at({2.73, -1.0})));                             // he is an obstacle all the same
  CHECK(scans_until_seen_to_move(watch, {{3.0, -1.0}, 0.27}, {0.0, 0.4}) <= 12);  // 0.8 s
  REQUIRE(watch.tracker.moving().size() == 1);
  CHECK(watch.tracker.moving()[0].id == name);
}

TEST_CASE("who stood for so long that he is a wall is seen to set out all the same, under his name") {
  Watch watch;
  for (int k = 0; k < 300; ++k) watch.see(with({{{3.0, -1.0}, 0.27}}));  // 20 s
  const EvidenceMap& still = watch.tracker.still();
  CHECK(still.stands(still.cell_at({2.73, -1.0})));
  REQUIRE(watch.tracker.tracks().size() == 1);
  const std::uint32_t name = watch.tracker.tracks()[0].id;
  CHECK(scans_until_seen_to_move(watch, {{3.0, -1.0}, 0.27}, {0.0, 0.4}) <= 9);  // 0.6 s
  REQUIRE(watch.tracker.moving().size() == 1);
  CHECK(watch.tracker.moving()[0].id == name);
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
      REQUIRE(watch.tracker.moving().size() == 1);
      const Track& track = watch.tracker.moving()[0];
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

TEST_CASE("walls that come into view behind a corner do not move") {
  Watch watch;
  Room room = rectangle(12.0, 10.0);
  room.walls.push_back({{1.0, -5.0}, {1.0, 0.5}});
  room.discs = {{{3.0, -2.0}, 0.3}, {{4.0, -1.0}, 0.15}, {{2.0, -0.5}, 0.1}};
  for (int k = 0; k < 150; ++k) watch.see(room, {-3.0 + 0.03 * k, 1.5, 0.0});  // 0.45 m/s past the corner
  CHECK(watch.most_moving == 0);
}

/// A disc 0.4 m in radius behind the end of a wall, seen past it.
void see_behind_a_wall(Watch& watch, double disc_y) {
  Room room = with({{{3.0, disc_y}, 0.4}});
  room.walls.push_back({{1.5, -5.0}, {1.5, -0.2}});
  watch.see(room, {-3.0, 0.5, 0.0});
}

TEST_CASE("a wide one who comes out from behind a wall is known within 0.6 s and does not hop once seen whole") {
  Watch watch;
  for (int k = 0; k < 75; ++k) see_behind_a_wall(watch, -1.2);
  int seen = 0, known_after = 0;
  for (int k = 0; k < 70; ++k) {
    see_behind_a_wall(watch, -1.2 + k / 30.0);  // 0.5 m/s to the left
    seen += watch.tracker.tracks().empty() ? 0 : 1;
    if (watch.tracker.moving().empty()) continue;
    if (known_after == 0) known_after = seen;
    CHECK(distance(watch.tracker.moving()[0].velocity_in_map, {0.0, 0.5}) < 0.8);  // a hop of 0.15 m: 1.7
  }
  CHECK(watch.tracker.moving().size() == 1);
  CHECK(watch.tracker.tracks()[0].id == 1);
  CHECK(known_after <= 9);
}

TEST_CASE("a wide thing that comes into view behind a wall as the robot drives does not move") {
  Watch watch;
  Room room = with({{{3.5, -0.6}, 0.4}});
  room.walls.push_back({{1.5, -5.0}, {1.5, -0.2}});
  for (int k = 0; k < 110; ++k) watch.see(room, {0.0, -1.5 + 0.04 * k, 0.0});  // 0.6 m/s across the wall's end
  CHECK(watch.most_moving == 0);
}

TEST_CASE("posts that are seen in turns are not one who walks") {
  Watch watch;
  watch.look_round();
  const double at[] = {-0.75, -0.25, 0.25, 0.75};  // 0.5 m apart, each returns beams for 0.4 s: a walk of 1.25 m/s
  for (int k = 0; k < 48; ++k) watch.see(with({{{2.0, at[k / 6 % 4]}, 0.05}}));
  CHECK(watch.most_moving == 0);
}

TEST_CASE("whoever stops becomes still and enters the map, and moves again when setting out") {
  Watch watch;
  watch.look_round();
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

TEST_CASE("two that cross keep their names") {
  Watch watch;
  watch.look_round();
  const auto near_at = [](int k) { return Vec2{2.0, -2.0 + 0.05 * k}; };
  const auto far_at = [](int k) { return Vec2{3.2, 2.0 - 0.05 * k}; };
  std::uint32_t near_id = 0, far_id = 0;
  const auto id_at = [&](Vec2 p) {
    for (const Track& t : watch.tracker.moving()) {
      if (distance(t.position_in_map, p) < 0.3) return t.id;
    }
    return 0U;
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
  Watch watch;
  watch.look_round();
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

TEST_CASE("who is hidden is believed in for a second, is no track after it, and comes out by his name") {
  Watch watch;
  watch.look_round();
  const auto hall_with = [](Disc walker) {
    Room room = rectangle(12.0, 10.0);
    room.walls.push_back({{1.5, 0.0}, {1.5, 1.2}});  // hides what is farther to the left than straight ahead, to y = 2
    room.discs = {walker};
    return room;
  };
  int alone = 0;
  std::uint32_t id = 0;
  for (int k = 0; k < 100; ++k) {
    watch.see(hall_with({{2.5, -3.0 + 0.06 * k}, 0.25}));  // behind the panel from k = 54 to 80
    const std::span<const Track> moving = watch.tracker.moving();
    if (k == 40) id = moving.empty() ? 0 : moving[0].id;
    if (k > 40 && watch.tracker.tracks().empty()) ++alone;
  }
  CHECK(id != 0);
  CHECK(alone > 5);
  CHECK(alone < 20);
  REQUIRE(watch.tracker.moving().size() == 1);
  CHECK(watch.tracker.moving()[0].id == id);
}

TEST_CASE("two legs are one walker") {
  Watch watch;
  watch.look_round();
  for (int k = 0; k < 60; ++k) {
    const double y = -2.0 + 0.06 * k, swing = 0.15 * jaywalk::sin(0.6 * k);
    watch.see(with({{{1.9, y + swing}, 0.06}, {{2.1, y - swing}, 0.06}}));
  }
  REQUIRE(watch.tracker.moving().size() == 1);
  CHECK(distance(watch.tracker.moving()[0].position_in_map, {2.0, 1.54}) < 0.25);
  CHECK(watch.tracker.tracks().size() == 1);
}

TEST_CASE("a track whose place is looked through dies within a second") {
  Watch watch;
  watch.look_round();
  for (int k = 0; k < 45; ++k) watch.see(with({{{2.0, -2.0 + 0.06 * k}, 0.27}}));
  REQUIRE(watch.tracker.moving().size() == 1);
  for (int k = 0; k < 16; ++k) watch.see(with({}));
  CHECK(watch.tracker.tracks().empty());
}

TEST_CASE("what returns nothing in six scans of seven is one and the same, what is looked through meanwhile is not") {
  const Disc somebody{{2.0, 0.5}, 0.1};
  for (const bool is_there : {true, false}) {
    Watch watch;
    watch.look_round();
    for (int k = 0; k < 15; ++k) {
      if (k % 7 > 0 && is_there) {
        watch.see_dark(somebody);
      } else {
        watch.see(k % 7 > 0 ? with({}) : with({somebody}));
      }
    }
    CHECK(watch.tracker.tracks().size() == (is_there ? 1U : 0U));  // seen three times
  }
}

TEST_CASE("scans without a single return change nothing") {
  Watch watch;
  watch.look_round();
  const EvidenceMap before = watch.tracker.still();
  LaserScan blind = scan_of(rectangle(12.0, 10.0), {}, ++watch.scan);
  for (float& r : blind.range_m) r = std::numeric_limits<float>::quiet_NaN();
  watch.tracker.update(blind, {});
  blind.beam_count = 0;
  watch.tracker.update(blind, {});
  blind.angle_step_rad = 0.0F;
  watch.tracker.update(blind, {});
  int changed = 0;
  for (int j = -128; j < 128; ++j) {
    for (int i = -128; i < 128; ++i)
      changed += watch.tracker.still().evidence({i, j}) != before.evidence({i, j}) ? 1 : 0;
  }
  CHECK(changed == 0);
  CHECK(watch.tracker.tracks().empty());
}

TEST_CASE("a pose that is not finite is refused") {
  Watch watch;
  watch.look_round();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  watch.tracker.update(scan_of(rectangle(12.0, 10.0), {}, ++watch.scan), {nan, 0.0, 0.0});
  CHECK(watch.tracker.tracks().empty());
}

TEST_CASE("more than fits is tracked to the last place and no farther") {
  Watch watch;
  watch.look_round();
  Room crowd = rectangle(12.0, 10.0);
  for (int ring = 0; ring < 3; ++ring) {
    for (int k = 0; k < 30; ++k) crowd.discs.push_back({direction(0.15 * k - 2.2) * (1.5 + 1.2 * ring), 0.05});
  }
  for (int k = 0; k < 12; ++k) {
    for (Disc& d : crowd.discs) d.centre = d.centre * 1.01;
    watch.see(crowd);
  }
  CHECK(watch.tracker.tracks().size() <= kMaxTracks);
  CHECK(watch.tracker.tracks().size() > 10);
}

TEST_CASE("the same scans give the same tracks bit for bit") {
  const auto run = [] {
    Watch watch;
    watch.look_round();
    for (int k = 0; k < 40; ++k) watch.see(with({{{2.0, -2.0 + 0.06 * k}, 0.27}, {{3.0 - 0.03 * k, 1.0}, 0.2}}));
    return std::vector<Track>(watch.tracker.tracks().begin(), watch.tracker.tracks().end());
  };
  const std::vector<Track> a = run(), b = run();
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].position_in_map == b[k].position_in_map);
    CHECK(a[k].velocity_in_map == b[k].velocity_in_map);
  }
}
