#include "planner/tracking/occlusion.h"
#include "planner/tracking/tuning.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr Vec2 kPlace{3.0, 1.0};
constexpr double kShinM = 0.1, kWallM = 0.25;

/// Two shins side by side.
Room with_legs(Vec2 place) { return with({{{place.x, place.y + 0.1}, 0.06}, {{place.x, place.y - 0.1}, 0.06}}); }

Targets somebody_at(Vec2 place, bool moves = false) {
  Targets targets;
  Target target = born_at(place, 0.05, 0.25, time_from_seconds(0.0), 1);
  target.existence.pedestrian.walks();
  target.estimate.track.hits = 3;
  target.estimate.track.moving = moves;
  (void)targets.push_back(target);
  return targets;
}

/// One point, `beside_m` from kPlace: a shin, or what he leant on.
EvidenceMap map_with(double beside_m) {
  EvidenceMap map(64, 0.1, kPlace);
  for (int k = 0; k < 6; ++k) map.add_hit(kPlace + Vec2{0.0, beside_m}, 10, 0.1);
  return map;
}

/// The only one who stands.
const StandingPedestrian& only_standing(const Watch& watch) {
  REQUIRE(watch.tracker.standing().size() == 1);
  return watch.tracker.standing()[0];
}

/// Of a laser whose beams pass over every place.
void note(Targets targets, const EvidenceMap& still, StandingCandidates& standing) {
  const LaserScan empty = scan_of(rectangle(12.0, 10.0), {}, 1);
  update_standing(targets, still, LineOfSight(empty, {}, {}, {}), empty.stamp, standing);
}

}  // namespace

TEST_CASE("who stands on two legs may be a pedestrian, as wide as people, for as long as he stands, new there or not") {
  Watch watch;
  if (GENERATE(false, true)) watch.look_round();
  Time since = kNever;
  for (int scan = 0; scan < 15 * 20; ++scan) {
    watch.see(with_legs(kPlace));
    if (scan < 15) continue;
    const StandingPedestrian& stands = only_standing(watch);
    if (scan == 15) since = stands.since;
    CHECK(stands.since == since);  // whether it is followed or in the map
    CHECK(distance(stands.position_in_map, kPlace) < 0.1);
    CHECK(stands.radius_m == Approx(0.25).margin(0.01));
  }
  CHECK(watch.tracker.tracks().empty());  // the map has his legs by now, and no more of him
  watch.look_round();
  CHECK(watch.tracker.standing().empty());
}

TEST_CASE("a pedestrian that shuffles about where it stands is one body, and has stood all the while") {
  SettledWatch watch;
  for (int scan = 0; scan < 15 * 6; ++scan) watch.see(with_legs(kPlace));
  const Time since = only_standing(watch).since;
  const double way_rad = GENERATE(0.0, 1.6, 3.1, 4.7);
  const Vec2 step = direction(way_rad) * (0.06 / 15.0);
  CAPTURE(way_rad);
  for (int scan = 1; scan <= 15 * 12; ++scan) {
    const Vec2 place = kPlace + step * scan;
    watch.see(with_legs(place));
    std::size_t bodies = 0;
    for (const Track& track : watch.tracker.tracks()) {
      CHECK(distance(track.position_in_map, place) < kSamePedestrianM);
      CHECK(to_seconds(track.still_since - since) < 3.0);
      ++bodies;
    }
    for (const StandingPedestrian& one : watch.tracker.standing()) {
      CHECK(distance(one.position_in_map, place) < kSamePedestrianM);
      CHECK(to_seconds(one.since - since) < 3.0);
      if (track_near(watch.tracker.tracks(), one.position_in_map, kSamePedestrianM) == nullptr) ++bodies;
    }
    CHECK(bodies <= 1);  // sideways, its legs are the map's alone for a while
  }
}

TEST_CASE("who is hidden where he stood stands for eight seconds yet, and no longer than his place is out of sight") {
  SettledWatch watch;
  for (int scan = 0; scan < 15; ++scan) watch.see(with_legs(kPlace));
  REQUIRE(watch.tracker.standing().size() == 1);
  Room screened = with_legs(kPlace);
  screened.walls.push_back({{1.8, 0.3}, {1.8, 1.2}});
  for (int scan = 0; scan < 15 * 15 / 2; ++scan) watch.see(screened);
  CHECK(distance(only_standing(watch).position_in_map, kPlace) < 0.1);
  SECTION("he is not seen again") {
    for (int scan = 0; scan < 15; ++scan) watch.see(screened);
    CHECK(watch.tracker.standing().empty());
  }
  SECTION("he has gone") {
    watch.see(rectangle(12.0, 10.0));
    CHECK(watch.tracker.standing().empty());
  }
  SECTION("one of his legs comes into view") {
    for (int scan = 0; scan < 15 * 9; ++scan) watch.see(with({{{kPlace.x, kPlace.y + 0.1}, 0.06}}));
    CHECK(watch.tracker.standing().size() == 1);
  }
}

TEST_CASE("who walked, stops, and goes out of what the laser looks at stands there for eight seconds yet") {
  SettledWatch watch;
  for (int scan = 0; scan < 60; ++scan) watch.see(with({{{2.0, -2.0 + 0.05 * scan}, 0.27}}));
  for (int scan = 0; scan < 8; ++scan) watch.see(with({{{2.0, 1.0}, 0.27}}));  // half a second: he is no stander yet
  REQUIRE(watch.tracker.moving().size() == 1);
  const Room still_there = with({{{2.0, 1.0}, 0.27}});
  const Pose2 turned{0.0, 0.0, -2.5};  // behind the robot 90 degrees are not looked at
  for (int scan = 0; scan < 15 * 7; ++scan) watch.see(still_there, turned);
  CHECK(watch.tracker.tracks().empty());
  CHECK(distance(only_standing(watch).position_in_map, {2.0, 1.0}) < 0.05);
  for (int scan = 0; scan < 15 * 2; ++scan) watch.see(still_there, turned);
  CHECK(watch.tracker.standing().empty());
}

TEST_CASE("one leg that stands where nothing stood may be a pedestrian's") {
  SettledWatch watch;
  for (int scan = 0; scan < 15; ++scan) watch.see(with({{kPlace, 0.06}}));
  CHECK(distance(only_standing(watch).position_in_map, kPlace) < 0.2);
}

TEST_CASE("one post, and two farther apart than legs, are nobody") {
  Watch watch;
  for (int scan = 0; scan < 60; ++scan) {
    watch.see(with({{{3.0, 0.0}, 0.06}, {{3.0, 0.8}, 0.06}, {{-2.0, 1.0}, 0.06}}));
    CHECK(watch.tracker.standing().empty());
  }
}

TEST_CASE("who walked and is no target any more stands while the map has something that near to his middle") {
  StandingCandidates standing;
  note(somebody_at(kPlace), map_with(kWallM), standing);
  REQUIRE(standing.size() == 1);
  note({}, map_with(kShinM), standing);
  CHECK(standing.size() == 1);
  CHECK(standing[0].radius_m == 0.25);
  note({}, map_with(kWallM), standing);
  CHECK(standing.empty());
}

TEST_CASE("who is followed again is not there twice, and who goes on stands no more") {
  StandingCandidates standing;
  note(somebody_at(kPlace), map_with(kShinM), standing);
  note(somebody_at(kPlace + Vec2{0.1, 0.0}), map_with(kShinM), standing);
  REQUIRE(standing.size() == 1);
  CHECK(standing[0].position_in_map == kPlace + Vec2{0.1, 0.0});
  note(somebody_at(kPlace + Vec2{0.2, 0.0}, true), map_with(kShinM), standing);
  CHECK(standing.empty());
}

TEST_CASE("who moves, and what is nobody, does not stand") {
  StandingCandidates standing;
  note(somebody_at(kPlace, true), map_with(kShinM), standing);
  Targets furniture = somebody_at(kPlace);
  furniture[0].existence.pedestrian = {};
  note(furniture, map_with(kShinM), standing);
  CHECK(standing.empty());
}

TEST_CASE("he is where he was seen last, wherever his track has gone meanwhile") {
  Targets targets = somebody_at(kPlace);
  targets[0].estimate.track.position_in_map = kPlace + Vec2{0.5, 0.0};
  StandingCandidates standing;
  note(targets, map_with(kShinM), standing);
  REQUIRE(standing.size() == 1);
  CHECK(standing[0].position_in_map == kPlace);
}

TEST_CASE("when there is no room left those who are followed have it") {
  StandingCandidates standing;
  const EvidenceMap map = map_with(kShinM);
  PedestrianBelief doubtful;  // two pedestrians in one place would be one
  doubtful.look(true, 0.0, time_from_seconds(0.0));
  for (std::size_t k = 0; k < standing.capacity(); ++k)
    (void)standing.push_back({kPlace, 0.25, kNever, kNever, doubtful});
  note(somebody_at(kPlace + Vec2{5.0, 0.0}), map, standing);
  CHECK(standing.full());
  CHECK(standing[0].position_in_map == kPlace + Vec2{5.0, 0.0});
}

TEST_CASE("a rider's feet are nobody beside the robot once it has turned") {
  Watch watch;
  for (int scan = 0; scan < 60; ++scan) {
    const Pose2 robot{0.0, 0.0, scan < 15 ? 0.0 : 0.05 * (scan - 15)};
    watch.see(with({{robot * Vec2{0.4, 0.12}, 0.06}, {robot * Vec2{0.4, -0.12}, 0.06}}), robot);
    if (scan == 15) CHECK(watch.tracker.standing().size() == 1);  // for all that it can know
  }
  CHECK(watch.tracker.standing().empty());
}

TEST_CASE("who walked here stands when he has stopped, no legs of his having been seen") {
  SettledWatch watch;
  for (int scan = 0; scan < 60; ++scan) watch.see(with({{{3.0, -2.0 + 0.05 * scan}, 0.27}}));
  CHECK(watch.tracker.standing().empty());
  for (int scan = 0; scan < 15 * 8; ++scan) watch.see(with({{{3.0, 1.0}, 0.27}}));
  CHECK(distance(only_standing(watch).position_in_map, {3.0, 1.0}) < 0.05);
}

TEST_CASE("who goes along beside the robot, as nobody else, may be a pedestrian") {
  SettledWatch watch;
  int unknown = 0;
  for (int k = 0; k < 90; ++k) {
    const Pose2 robot{-3.0 + 0.05 * k, 0.0, 0.0};
    watch.see(with({{robot * Vec2{0.1, 0.75}, 0.22}}), robot);
    const auto known = watch.tracker.moving().size() + watch.tracker.standing().size();
    if (k > 30 && known == 0) ++unknown;
  }
  CHECK(unknown == 0);
}
