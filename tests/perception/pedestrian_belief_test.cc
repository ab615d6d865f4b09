// Legs seen from many sides are a pedestrian; furniture that looks like legs once is none.
#include "planner/tracking/pedestrian_belief.h"

#include <memory>

#include "tests/perception/cut_scan.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

Time at(double s) { return time_from_seconds(s); }

/// Looks from bearings `from_rad` to `to_rad`, twenty times, at once.
void look_round_it(PedestrianBelief& belief, bool two_legs, double from_rad, double to_rad) {
  for (int k = 0; k <= 20; ++k) belief.look(two_legs, from_rad + (to_rad - from_rad) * k / 20.0, at(1.0));
}

/// A robot that drives by 1.5 m beside (3, 1), at 0.6 m/s.
void drive_by(Watch& watch, const Room& room) {
  for (int scan = 0; scan < 15 * 10; ++scan) watch.see(room, {0.04 * scan, -0.5, 0.3});
}

std::size_t standing_at(const Watch& watch, Vec2 place) {
  std::size_t count = 0;
  for (const StandingPedestrian& one : watch.tracker.standing())
    count += distance(one.position_in_map, place) < 0.3 ? 1U : 0U;
  return count;
}

}  // namespace

TEST_CASE("the same view again tells nothing new but for one more in the first seconds") {
  PedestrianBelief belief;
  for (int k = 0; k < 1000; ++k) belief.look(true, 0.3, at(1.0));
  CHECK_FALSE(belief.is_pedestrian());  // one view
  belief.look(true, 0.3, at(2.0));
  CHECK(belief.is_pedestrian());
  CHECK(belief.new_views(0.3, at(2.0)) == 0.0);
  CHECK(belief.new_views(0.3, at(100.0)) == Approx(2.0 / 3.0));
  belief.look(true, 0.3, at(100.0));
  CHECK(belief.new_views(0.3, at(200.0)) == 0.0);
  CHECK(belief.new_views(0.3 + 2.0 * kPi, at(200.0)) == Approx(0.0).margin(1e-9));
  CHECK(belief.new_views(-2.0, at(200.0)) == 1.0);
}

TEST_CASE(
    "legs that hide one another for a quarter of the way round are a pedestrian still, as are those that walked") {
  PedestrianBelief legs, walker, post;
  look_round_it(legs, true, 0.0, 1.5);
  look_round_it(legs, false, 1.5, 3.0);
  CHECK(legs.is_pedestrian());
  walker.walks();
  look_round_it(walker, false, 0.0, 3.0);
  CHECK(walker.is_pedestrian());
  look_round_it(post, false, 0.0, 3.0);
  CHECK_FALSE(post.is_pedestrian());
  CHECK_FALSE(post.may_be_pedestrian());
}

TEST_CASE("nothing stays a pedestrian for ever") {
  PedestrianBelief belief;
  SECTION("legs") { look_round_it(belief, true, 0.0, 6.0); }
  SECTION("it came") { belief.came(); }
  SECTION("it walked") { belief.walks(); }
  for (int round = 0; round < 3; ++round) look_round_it(belief, false, 0.0, 6.0);
  CHECK_FALSE(belief.is_pedestrian());
}

TEST_CASE("a target takes over the better of two beliefs") {
  PedestrianBelief target, before;
  before.walks();
  target.inherit(before);
  CHECK(target.is_pedestrian());
  target.inherit({});
  CHECK(target.is_pedestrian());
}

TEST_CASE("whose two legs were seen stays a pedestrian while a robot passes, in the map or not, legs in line or not") {
  Watch watch;
  drive_by(watch, with({{{3.0, 1.1}, 0.06}, {{3.0, 0.9}, 0.06}}));
  CHECK(standing_at(watch, {3.0, 1.0}) == 1);
}

TEST_CASE("a table on four legs, a post, and a post beside a wall are nobody") {
  const auto [room, place] = GENERATE(table<Room, Vec2>(
      {{with({{{2.6, 0.7}, 0.03}, {{2.6, 1.4}, 0.03}, {{3.6, 0.7}, 0.03}, {{3.6, 1.4}, 0.03}}), Vec2{2.6, 0.7}},
       {with({{{3.0, 1.0}, 0.06}}), Vec2{3.0, 1.0}},
       {with({{{3.0, 4.7}, 0.06}}), Vec2{3.0, 4.7}}}));
  Watch watch;
  drive_by(watch, room);
  CHECK(standing_at(watch, place) == 0);
}

TEST_CASE("furniture that comes into view is nobody, though its ground had been unseen") {
  Watch watch;
  drive_by(watch, with({{{3.0, 1.0}, 0.05}, {{4.0, 2.0}, 0.05}, {{4.5, 1.0}, 0.05}}, {{{2.0, 0.3}, {2.0, 1.5}}}));
  CHECK(watch.tracker.standing().empty());
}

TEST_CASE("nothing is told of what is hidden, too far off, or as wide as people") {
  const auto legs_of = [](const Room& room, Vec2 place, const Fan& fan = {}) {
    const auto cut = std::make_unique<CutScan>(scan_of(room, {}, 1, 0.0, fan));
    return two_legs_at(place, *cut);
  };
  const Vec2 place{3.0, 0.0};
  CHECK(legs_of(with({{{3.0, 0.1}, 0.06}, {{3.0, -0.1}, 0.06}}), place) == true);
  CHECK(legs_of(with({{{3.0, 0.1}, 0.06}, {{3.2, 0.02}, 0.06}}), place) == std::nullopt);  // half hidden
  CHECK(legs_of(with({{place, 0.06}}), place) == false);
  CHECK(legs_of(with({{{3.0, 0.2}, 0.04}, {place, 0.04}, {{3.0, -0.2}, 0.04}}), place) == false);
  CHECK(legs_of(with({{place, 0.25}}), place) == std::nullopt);
  CHECK(legs_of(with({}), place) == std::nullopt);
  const Fan coarse{.beams = 181, .first_rad = -0.5 * kPi, .step_rad = kPi / 180.0};
  CHECK(legs_of(with({{{5.0, 0.1}, 0.06}, {{5.0, -0.1}, 0.06}}), {5.0, 0.0}, coarse) == std::nullopt);
}
