#include "planner/tracking/target.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

Observation at(double x, double std_m) {
  Observation seen;
  seen.position_in_map = {x, 0.0};
  seen.std_m = std_m;
  seen.radius_m = 0.25;
  return seen;
}

Observation two_legs_at(double x) {
  Observation seen = at(x, 0.07);
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
    Observation seen = at(3.6, 0.21);
    seen.lone_leg = said_to_be_one;
    update_with(target, seen, {}, time_from_seconds(k / 15.0));
  }
  return target.estimate.track.velocity_in_map.x;
}

}  // namespace

TEST_CASE("whose middle is seen well does not stop when one leg alone is seen to stand") {
  CHECK(walker_seen_well().appearance.noise < 0.2);
  CHECK(speed_after_a_standing_leg(true) > 0.6);
  CHECK(speed_after_a_standing_leg(false) < 0.3);  // as if it were as sure as both legs
}

TEST_CASE("who shows two legs has no arc, and who no longer does may have one again") {
  Target target = walker_seen_well();
  CHECK(target.appearance.on_legs());
  Observation wide = at(3.6, 0.01);
  wide.arc_m = 0.25;
  target.appearance.arc_m = 0.25;
  update_with(target, two_legs_at(3.6), {}, time_from_seconds(3.1));
  CHECK(target.appearance.arc_m == 0.0);
  for (int k = 0; k < 20; ++k) update_with(target, wide, {}, time_from_seconds(3.2 + k / 15.0));
  CHECK_FALSE(target.appearance.on_legs());
  CHECK(target.appearance.arc_m == Approx(0.25));
}
