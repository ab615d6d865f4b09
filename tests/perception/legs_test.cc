// What the tracker makes of people, whose legs take turns.
#include <cmath>

#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Two shins of somebody who walks across, `way_m` after he set out from `from`, at 0.8 m/s: steps of 0.56 m, of which
/// shins do two thirds to and fro (hal/sim/world.h).
Room with_walker(Vec2 from, double way_m) {
  const double steps = way_m / 0.56, of_two = steps - 2.0 * std::floor(0.5 * steps);
  const double ahead = 0.187 * (of_two < 1.0 ? 1.0 - 2.0 * of_two : 2.0 * of_two - 3.0);
  Room room = rectangle(20.0, 20.0);
  room.discs = {{{from.x + 0.1, from.y + way_m + ahead}, 0.06}, {{from.x - 0.1, from.y + way_m - ahead}, 0.06}};
  return room;
}

}  // namespace

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
