#include <limits>
#include <span>

#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

TEST_CASE("walls that come into view behind a corner do not move") {
  Watch watch;
  const Room room = with({{{3.0, -2.0}, 0.3}, {{4.0, -1.0}, 0.15}, {{2.0, -0.5}, 0.1}}, {{{1.0, -5.0}, {1.0, 0.5}}});
  for (int k = 0; k < 150; ++k) watch.see(room, {-3.0 + 0.03 * k, 1.5, 0.0});  // 0.45 m/s past the corner
  CHECK(watch.most_moving == 0);
}

/// A disc 0.4 m in radius behind the end of a wall, seen past it.
void see_behind_a_wall(Watch& watch, double disc_y) {
  watch.see(with({{{3.0, disc_y}, 0.4}}, {{{1.5, -5.0}, {1.5, -0.2}}}), {-3.0, 0.5, 0.0});
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
  const double radius_m = GENERATE(0.4, 0.5, 0.75);
  const Room room = with({{{3.5, -0.2 - radius_m}, radius_m}}, {{{1.5, -5.0}, {1.5, -0.2}}});
  for (int k = 0; k < 110; ++k) watch.see(room, {0.0, -1.5 + 0.04 * k, 0.0});  // 0.6 m/s across the wall's end
  CHECK(watch.most_moving == 0);
}

TEST_CASE("who is hidden is believed in for a second, is no track after it, and comes out by his name") {
  SettledWatch watch;
  const Wall panel{{1.5, 0.0}, {1.5, 1.2}};  // hides what is farther to the left than straight ahead, to y = 2
  int alone = 0;
  std::uint32_t id = 0;
  for (int k = 0; k < 100; ++k) {
    watch.see(with({{{2.5, -3.0 + 0.06 * k}, 0.25}}, {panel}));  // behind the panel from k = 54 to 80
    const std::span<const Track> moving = watch.tracker.moving();
    if (k == 40) id = moving.empty() ? 0 : moving[0].id;
    if (k > 40 && moving.empty()) ++alone;
  }
  CHECK(id != 0);
  CHECK(alone > 5);
  CHECK(alone < 20);
  CHECK(only_mover(watch.tracker).id == id);
}

TEST_CASE("a track whose place is looked through dies within a second") {
  SettledWatch watch;
  for (int k = 0; k < 45; ++k) watch.see(with({{{2.0, -2.0 + 0.06 * k}, 0.27}}));
  REQUIRE(watch.tracker.moving().size() == 1);
  for (int k = 0; k < 16; ++k) watch.see(with({}));
  CHECK(watch.tracker.tracks().empty());
}

TEST_CASE("what returns nothing in six scans of seven is one and the same, what is looked through meanwhile is not") {
  const Disc somebody{{2.0, 0.5}, 0.1};
  for (const bool is_there : {true, false}) {
    SettledWatch watch;
    for (int k = 0; k < 15; ++k) {
      const bool returns_nothing = k % 7 > 0;
      if (returns_nothing && is_there)
        watch.see_dark(somebody);
      else
        watch.see(returns_nothing ? with({}) : with({somebody}));
    }
    CHECK(watch.tracker.tracks().size() == (is_there ? 1U : 0U));  // seen three times
  }
}

TEST_CASE("scans without a single return change nothing") {
  SettledWatch watch;
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
