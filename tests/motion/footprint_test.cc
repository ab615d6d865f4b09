// The body of a wheelchair, 0.75 m before its axle, 0.35 m behind and 0.325 m to either side, among walls.
#include <array>
#include <cmath>

#include "planner/motion/body_map.h"
#include "planner/motion/footprint_guide.h"
#include "planner/motion/manoeuvre_drive.h"
#include "planner/motion/manoeuvre_search.h"
#include "planner/motion/way_cost.h"
#include "tests/motion/ground.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::Ground;

namespace {

constexpr Duration kScan{66'666'667};  // of 15 Hz

const RobotModel kChair = wheelchair();

/// A wall along x = 2 with a door of 0.90 m about y = 0.
Ground door() { return Ground().wall({2.03, -3.0}, {2.03, -0.45}).wall({2.03, 0.45}, {2.03, 3.0}); }

/// A corridor of 1.2 m along x whose end, at x = 3, opens to the left only.
Ground corner() {
  return Ground()
      .wall({-3.0, -0.6}, {3.0, -0.6})
      .wall({3.0, -0.6}, {3.0, 5.0})
      .wall({-3.0, 0.6}, {1.8, 0.6})
      .wall({1.8, 0.6}, {1.8, 5.0});
}

/// A corridor of 1.2 m along x, closed at x = 1 and open to the left beyond x = -2.
Ground dead_end() {
  return Ground()
      .wall({1.0, -0.6}, {1.0, 0.6})
      .wall({-3.9, -0.6}, {1.0, -0.6})
      .wall({-1.5, 0.6}, {1.0, 0.6})
      .wall({-1.5, 0.6}, {-1.5, 4.0});
}

double least_clearance(const BodyMap& map, const Manoeuvre& manoeuvre) {
  double least = 1.0;
  for (const ManoeuvreStep& step : manoeuvre) least = std::min(least, map.clearance(step.map_from_robot));
  return least;
}

int count(const Manoeuvre& manoeuvre, Gear gear) {
  int n = 0;
  for (const ManoeuvreStep& step : manoeuvre) n += step.gear == gear ? 1 : 0;
  return n;
}

}  // namespace

TEST_CASE("a body's clearance is that of its outline, ahead 0.75 m from the axle and beside 0.325 m") {
  const Ground ground = Ground().wall({1.05, -2.0}, {1.05, 2.0});
  BodyMap map(kChair.footprint);
  map.draw(ground.map(), {});
  CHECK(map.clearance({0.0, 0.0, 0.0}) == Approx(0.30).margin(0.01));         // 1.05 - 0.75
  CHECK(map.clearance({0.6, 0.0, kPi / 2.0}) == Approx(0.125).margin(0.01));  // 1.05 - 0.6 - 0.325
  CHECK(map.clearance({0.6, 0.0, kPi}) == Approx(0.10).margin(0.01));         // 1.05 - 0.6 - 0.35
  CHECK(map.clearance({0.3, 0.0, 0.0}) == Approx(0.0).margin(0.025));         // its front in the wall
  CHECK(map.clearance({-2.0, 0.0, 0.0}) == BodyMap::kFar_m);
}

TEST_CASE("somebody who stands is to a body as wide as he is, and 5 cm wider") {
  const Ground ground;
  BodyMap map(kChair.footprint);
  const std::array<StandingPedestrian, 1> standing{{{{1.30, 0.0}, 0.25}}};
  map.draw(ground.map(), {}, standing);
  CHECK(map.clearance({0.0, 0.0, 0.0}) == Approx(0.25).margin(0.01));         // 1.30 - 0.25 - 0.05 - 0.75
  CHECK(map.clearance({0.6, 0.0, kPi / 2.0}) == Approx(0.075).margin(0.01));  // 1.30 - 0.30 - 0.6 - 0.325
  map.draw(ground.map(), {});
  CHECK(map.clearance({0.0, 0.0, 0.0}) == BodyMap::kFar_m);
}

TEST_CASE("turned in a door of 0.90 m the body comes nearer than its half width has it") {
  BodyMap map(kChair.footprint);
  map.draw(door().map(), {1.0, 0.0, 0.0});
  // Straight: 0.45 - 0.325 = 0.125. Turned by 0.1 rad a front corner is 0.75 sin 0.1 = 0.075 further aside.
  CHECK(map.clearance({1.3, 0.0, 0.0}) == Approx(0.125).margin(0.015));
  CHECK(map.clearance({1.3, 0.0, 0.1}) < 0.08);
  CHECK(map.clearance({1.3, 0.0, 0.1}) > 0.03);
}

TEST_CASE("what was never seen is told from what was, and the place that it stands on counts as seen") {
  EvidenceMap blank(256, 0.1, {0.0, 0.0});
  BodyMap map(kChair.footprint);
  map.draw(blank, {});
  CHECK_FALSE(map.goes_unseen({0.0, 0.0}, {1.0, 0.0}));
  CHECK(map.goes_unseen({-0.5, 0.0}, {1.0, 0.0}));
  CHECK(map.goes_unseen({0.0, 0.0}, {0.0, 1.0}));
  const Ground seen;
  map.draw(seen.map(), {});
  CHECK_FALSE(map.goes_unseen({-0.5, 0.0}, {1.0, 0.0}));
}

TEST_CASE("the circle's way goes round a wall, and there is none into a closed room") {
  BodyMap map(kChair.footprint);
  WayCost way(0.325);
  const Ground ground = Ground().wall({1.03, -1.0}, {1.03, 4.0});
  map.draw(ground.map(), {1.0, 0.0, 0.0});
  way.settle(map, {2.0, 0.0});
  // From (0, 0): to (1, -1.4) and back, two legs of hypot(1, 1.4) = 1.72 m; on eight neighbours 1.81 m.
  CHECK(way.from({0.0, 0.0}) > 3.3F);
  CHECK(way.from({0.0, 0.0}) < 3.9F);
  CHECK(std::isinf(way.from({1.03, 0.5})));
  CHECK(std::isinf(way.from({50.0, 0.5})));
}

TEST_CASE("through a door of 0.90 m the search finds a way for the body from many places and headings") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  const Ground ground = door();
  int found = 0, tried = 0;
  for (const double y : {-1.0, 0.0, 1.0}) {
    for (const double heading : {-1.0, 0.0, 1.0, 3.0}) {
      const Pose2 start{0.0, y, heading};
      map.draw(ground.map(), start);
      ++tried;
      Manoeuvre manoeuvre = search.find(map, start, {.position_in_map = {2.9, 0.1}, .heading = 0.0}, 0.09);
      if (manoeuvre.size() < 2) continue;
      ++found;
      CHECK(least_clearance(map, manoeuvre) > 0.085);
      CHECK(distance(manoeuvre.back().map_from_robot.position(), {2.9, 0.1}) < 0.16);
      CHECK(manoeuvre[0].map_from_robot == start);
    }
  }
  CHECK(tried == 12);
  CHECK(found >= 11);
}

TEST_CASE("no manoeuvre leads through a door of 0.70 m, nor into a wall") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  const Ground ground = Ground().wall({2.03, -3.9}, {2.03, -0.35}).wall({2.03, 0.35}, {2.03, 3.9});
  map.draw(ground.map(), {0.5, 0.0, 0.0});
  CHECK(search.find(map, {0.5, 0.0, 0.0}, {.position_in_map = {3.0, 0.0}}, 0.075).empty());
  CHECK(search.find(map, {0.5, 0.0, 0.0}, {.position_in_map = {2.03, 1.0}}, 0.075).empty());
}

TEST_CASE("round the corner of a corridor of 1.2 m the body goes forward, in arcs") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  const Ground ground = corner();
  map.draw(ground.map(), {1.0, 0.0, 0.0});
  const Manoeuvre& manoeuvre =
      search.find(map, {1.0, 0.0, 0.0}, {.position_in_map = {2.4, 1.7}, .heading = kPi / 2.0}, 0.09);
  REQUIRE(manoeuvre.size() > 20);
  CHECK(count(manoeuvre, Gear::kForward) > count(manoeuvre, Gear::kBackward));
  CHECK(least_clearance(map, manoeuvre) > 0.085);
}

TEST_CASE("out of a dead end it cannot turn in, the body goes backward") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  const Ground ground = dead_end();
  map.draw(ground.map(), {0.0, 0.0, 0.0});
  const Manoeuvre& manoeuvre =
      search.find(map, {0.0, 0.0, 0.0}, {.position_in_map = {-2.4, 0.5}, .heading = 2.0}, 0.09);
  REQUIRE(manoeuvre.size() > 10);
  CHECK(manoeuvre[1].gear == Gear::kBackward);
  CHECK(count(manoeuvre, Gear::kBackward) > 10);
  CHECK(least_clearance(map, manoeuvre) > 0.085);
}

TEST_CASE("a body too near to something leaves it and comes no nearer") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  const Ground ground = Ground().wall({-2.0, 0.37}, {2.0, 0.37});  // 4.5 cm beside it
  map.draw(ground.map(), {0.0, 0.0, 0.0});
  const Manoeuvre& manoeuvre =
      search.find(map, {0.0, 0.0, 0.0}, {.position_in_map = {1.5, -1.0}, .heading = -0.5}, 0.10);
  REQUIRE(manoeuvre.size() > 5);
  CHECK(least_clearance(map, manoeuvre) > 0.03);
  CHECK(map.clearance(manoeuvre.back().map_from_robot) >= 0.10);
}

TEST_CASE("a manoeuvre is driven to its end: forward, on the spot and back, backward at most at 0.3 m/s") {
  Manoeuvre manoeuvre;
  double x = 0.0;
  for (; x < 0.95; x += 0.1) REQUIRE(manoeuvre.push_back({{x, 0.0, 0.0}, Gear::kForward, 0.5, 0.0}));
  for (double turn = 0.13; turn < 1.6; turn += 0.13) {
    REQUIRE(manoeuvre.push_back({{0.9, 0.0, turn}, Gear::kTurn, 0.5, 0.0}));
  }
  const double last = manoeuvre.back().map_from_robot.heading;
  for (double back = 0.1; back < 0.65; back += 0.1) {
    const Vec2 place = Vec2{0.9, 0.0} + direction(last) * -back;
    REQUIRE(manoeuvre.push_back({{place.x, place.y, last}, Gear::kBackward, 0.5, 0.0}));
  }
  ManoeuvreDrive drive(kChair.limits);
  drive.begin(manoeuvre);
  Pose2 pose{0.0, 0.03, 0.05};  // begun a little beside it
  double slowest = 0.0, farthest_off = 0.0;
  int ticks = 0;
  for (; drive.active() && ticks < 2000; ++ticks) {
    const Twist2 twist = drive.command(pose);
    slowest = std::min(slowest, twist.v_mps);
    farthest_off = std::max(farthest_off, drive.off_by(pose));
    const Vec2 ahead = direction(pose.heading + 0.01 * twist.w_radps);
    pose = {pose.x + 0.02 * twist.v_mps * ahead.x, pose.y + 0.02 * twist.v_mps * ahead.y,
            pose.heading + 0.02 * twist.w_radps};
  }
  CHECK_FALSE(drive.active());
  CHECK(ticks < 1000);
  CHECK(distance(pose.position(), manoeuvre.back().map_from_robot.position()) < 0.04);
  CHECK(pose.heading == Approx(last).margin(0.05));
  CHECK(slowest < -0.1);
  CHECK(slowest >= -0.3);
  CHECK(farthest_off < 0.12);
}

TEST_CASE("the guide lets the body follow in the open, slows or swings it at a door, and backs it out of a dead end") {
  const auto line = [](Vec2 from, Vec2 to) {
    Path path;
    for (int k = 0; k <= 40; ++k) REQUIRE(path.push_back(from + (to - from) * (k / 40.0)));
    return path;
  };
  const auto look = [](FootprintGuide& guide, const Ground& ground, const Path& path, const Pose2& pose, int looks) {
    for (int k = 0; k < looks; ++k) {
      guide.update({.path = path,
                    .map_from_robot = pose,
                    .wanted = {},
                    .driven = {},
                    .still = ground.map(),
                    .now = Time{kScan * k}});
    }
  };
  FootprintGuide free(kChair.footprint, kChair.limits);
  look(free, Ground(), line({0, 0}, {3, 0}), {}, 10);
  CHECK(std::isinf(free.most_speed_mps()));
  CHECK_FALSE(free.manoeuvre().active());

  // To the goal the circle goes aslant through the door, the body cannot.
  FootprintGuide at_door(kChair.footprint, kChair.limits);
  look(at_door, door(), line({0.6, -1.0}, {3.4, 1.0}), {0.6, -1.0, 0.62}, 10);
  CHECK(at_door.manoeuvre().active());

  FootprintGuide in_dead_end(kChair.footprint, kChair.limits);
  look(in_dead_end, dead_end(), line({0, 0}, {-3, 0}), {}, 10);
  REQUIRE(in_dead_end.manoeuvre().active());
  CHECK(in_dead_end.manoeuvre().command({}).v_mps < 0.0);
}

TEST_CASE("who walks and has all but stopped is drawn where he is, who walks on is not") {
  Track track;
  track.position_in_map = {1.3, 0.0};
  track.radius_m = 0.25;
  BodyMap map(kChair.footprint);
  for (const double speed : {0.1, 0.5}) {
    track.velocity_in_map = {0.0, speed};
    map.draw(Ground().map(), {}, {}, std::array{track});
    CHECK(map.clearance({}) == Approx(speed < 0.3 ? 0.25 : BodyMap::kFar_m).margin(0.02));  // 1.3 - 0.30 - 0.75
  }
}

TEST_CASE("a manoeuvre for one goal is not driven for another") {
  const Ground ground = dead_end();
  Path path;
  for (int k = 0; k <= 40; ++k) REQUIRE(path.push_back({-3.0 * (k / 40.0), 0.0}));
  FootprintGuide guide(kChair.footprint, kChair.limits);
  Time now{};
  const auto look = [&](Vec2 goal) {
    guide.update({.path = path, .still = ground.map(), .goal_in_map = goal, .now = now += kScan});
  };
  for (int k = 0; k < 10; ++k) look({-3.0, 0.0});
  REQUIRE(guide.manoeuvre().active());
  look({-3.0, 0.1});
  CHECK(guide.manoeuvre().active());
  look({0.2, 0.0});
  CHECK_FALSE(guide.manoeuvre().active());
}

TEST_CASE("refused, the guide backs off where it has seen what is behind, and waits for five seconds where not") {
  EvidenceMap unseen(256, 0.1, {1.0, 1.0});
  for (int j = -10; j < 10; ++j) {
    for (int i = 0; i < 40; ++i) unseen.add({i, j}, -40);
  }
  Path path;
  for (int k = 0; k <= 40; ++k) REQUIRE(path.push_back({0.05 * k, 0.0}));
  const Ground ground;
  const auto seconds_until_off = [&](const EvidenceMap& still, bool hidden, double scans_hz) {
    FootprintGuide guide(kChair.footprint, kChair.limits);
    double now_s = -1.0 / scans_hz;
    while (now_s < 20.0 && !guide.manoeuvre().active()) {
      now_s += 1.0 / scans_hz;
      guide.update({.path = path,
                    .wanted = {0.3, 0.0},
                    .still = still,
                    .goal_in_map = {2.0, 0.0},
                    .pedestrian_hidden = hidden,
                    .now = time_from_seconds(now_s)});
    }
    return now_s;
  };
  for (const double scans_hz : {5.0, 15.0, 40.0}) {
    CAPTURE(scans_hz);
    const double scan_s = 1.01 / scans_hz;
    CHECK(seconds_until_off(ground.map(), false, scans_hz) == Approx(1.0).margin(scan_s));
    CHECK(seconds_until_off(ground.map(), true, scans_hz) == Approx(5.0).margin(scan_s));
    CHECK(seconds_until_off(unseen, false, scans_hz) == Approx(5.0).margin(scan_s));
  }
}

TEST_CASE("a manoeuvre that backs waits for five seconds while somebody near is out of sight") {
  const Ground ground = dead_end();
  Path path;
  for (int k = 0; k <= 40; ++k) REQUIRE(path.push_back({-3.0 * (k / 40.0), 0.0}));
  const auto seconds_until_off = [&](bool hidden, double scans_hz) {
    FootprintGuide guide(kChair.footprint, kChair.limits);
    double now_s = -1.0 / scans_hz;
    while (now_s < 20.0 && !guide.manoeuvre().active()) {
      now_s += 1.0 / scans_hz;
      guide.update({.path = path, .still = ground.map(), .pedestrian_hidden = hidden, .now = time_from_seconds(now_s)});
    }
    return now_s;
  };
  for (const double scans_hz : {5.0, 15.0, 40.0}) {
    CAPTURE(scans_hz);
    CHECK(seconds_until_off(false, scans_hz) == Approx(0.45).margin(1.01 / scans_hz));
    CHECK(seconds_until_off(true, scans_hz) == Approx(5.0).margin(1.01 / scans_hz));
  }
}
