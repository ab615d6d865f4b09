// A body that is nearer to something than it should be where it begins: it may leave it, or pass it alike, and drives
// over nothing else.
#include <cmath>
#include <vector>

#include "planner/motion/body_map.h"
#include "planner/motion/footprint_guide.h"
#include "planner/motion/least_clearance.h"
#include "planner/motion/manoeuvre_search.h"
#include "planner/motion/turned_piece.h"
#include "tests/motion/ground.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::Ground;

namespace {

const RobotModel kChair = wheelchair();

/// A wall `off_m` beside its left side, another 0.48 m beside its right one.
Ground beside(double off_m) {
  const double left = kChair.footprint.half_width_m + off_m;
  return Ground().wall({-2.0, left}, {2.5, left}).wall({-2.0, -0.8}, {2.5, -0.8});
}

double depth_of(Vec2 p, const Pose2& body) {
  const Footprint& f = kChair.footprint;
  const Vec2 q = inverse(body) * p;
  return std::min({f.front_m - q.x, q.x + f.rear_m, f.half_width_m - std::fabs(q.y)});
}

}  // namespace

TEST_CASE("clearance is a depth where something is inside the body") {
  BodyMap map(kChair.footprint);
  for (const double x : {-0.2, 0.1, 0.3, 0.5}) {
    const Ground ground = Ground().wall({x, 0.1}, {x + 0.01, 0.1});
    map.draw(ground.map(), {});
    CHECK(map.clearance({}) < -0.1);
    CHECK(map.clearance({-1.5, 0.0, 0.0}) > 0.0);
  }
}

TEST_CASE("over a whole way no more than unevenness is lost of a start's little room") {
  double room = 0.04;
  for (int step = 0; step < 100; ++step) room = least_clearance_m(0.10, 0.04, room);
  CHECK(room == Approx(0.038));
  CHECK(least_clearance_m(0.10, 0.04, 0.09) == Approx(0.088));
  CHECK(least_clearance_m(0.10, 0.30, 0.20) == 0.10);
}

TEST_CASE("from a start beside a wall no manoeuvre drives over a pole ahead") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  int found = 0;
  for (const double off_m : {0.0, 0.01, 0.02, 0.03, 0.04, 0.05}) {
    for (double x = 0.85; x < 1.6; x += 0.05) {
      for (const double y : {-0.2, 0.0, 0.1}) {
        const Ground ground = beside(off_m).wall({x, y}, {x + 0.01, y});
        map.draw(ground.map(), {});
        const Manoeuvre& way = search.find(map, {}, {.position_in_map = {2.3, -0.1}, .heading = 0.0}, 0.075);
        found += way.size() < 2 ? 0 : 1;
        double deepest = -1.0;
        for (const ManoeuvreStep& step : way) deepest = std::max(deepest, depth_of({x, y}, step.map_from_robot));
        CAPTURE(off_m, x, y);
        CHECK(deepest < 0.05);
      }
    }
  }
  CHECK(found > 100);  // to the right of a pole at 0 or 0.1 m
}

TEST_CASE("from a start beside a wall there is a manoeuvre along it, and away from it") {
  ManoeuvreSearch search(kChair.footprint);
  BodyMap map(kChair.footprint);
  for (const double off_m : {0.01, 0.02, 0.03, 0.05}) {
    const Ground ground = beside(off_m);
    map.draw(ground.map(), {});
    CAPTURE(off_m);
    CHECK(search.find(map, {}, {.position_in_map = {1.5, -0.1}, .heading = 0.0}, 0.075).size() > 1);
  }
}

TEST_CASE("a path that leads into a wall bit by bit is not followed from a start with little room") {
  const Ground ground =
      Ground().wall({-2.0, -0.8}, {2.5, -0.8}).wall({-2.0, 0.375}, {0.9, 0.375}).wall({0.9, 0.375}, {3.0, 0.315});
  Path path;
  for (int k = 0; k <= 40; ++k) (void)path.push_back({0.05 * k, 0.0});
  FootprintGuide guide(kChair.footprint, kChair.limits);
  guide.update({.path = path, .map_from_robot = {}, .wanted = {}, .driven = {}, .still = ground.map()});
  CHECK(guide.most_speed_mps() == 0.0);
}

TEST_CASE("a turn on the spot goes as far as there is room, and into nothing unseen") {
  BodyMap map(kChair.footprint);
  Manoeuvre turn;
  const Ground open;
  map.draw(open.map(), {});
  draw_turn(map, {}, 1.75, 0.075, turn);
  CHECK(turn.back().map_from_robot.heading == Approx(1.75).margin(kPi / 24.0));
  draw_turn(map, {}, -1.75, 0.075, turn);
  CHECK(turn.back().map_from_robot.heading == Approx(-1.75).margin(kPi / 24.0));
  const Ground ground = Ground().wall({0.5, 0.65}, {0.5, 0.66});  // the left front corner passes it at 45 degrees or so
  map.draw(ground.map(), {});
  draw_turn(map, {}, 1.75, 0.075, turn);
  CHECK(turn.size() > 1);
  for (const ManoeuvreStep& step : turn) CHECK(map.clearance(step.map_from_robot) > 0.07);
  CHECK(turn.back().map_from_robot.heading < 0.5);
  EvidenceMap blank(256, 0.1, {0.0, 0.0});
  map.draw(blank, {});
  draw_turn(map, {}, 1.75, 0.075, turn);
  CHECK(turn.size() < 5);
}

TEST_CASE("where nothing is to be done for ten seconds the guide looks round, once to either side") {
  Ground box;
  box.wall({-1.2, -1.2}, {1.2, -1.2})
      .wall({1.2, -1.2}, {1.2, 1.2})
      .wall({1.2, 1.2}, {-1.2, 1.2})
      .wall({-1.2, 1.2}, {-1.2, -1.2});
  Path out;
  for (int k = 0; k <= 30; ++k) (void)out.push_back({-0.1 * k, 0.0});
  FootprintGuide guide(kChair.footprint, kChair.limits);
  Pose2 pose;
  std::vector<double> turns;  // of the manoeuvres that do nothing else
  for (int looks = 0; looks < 15 * 90; ++looks) {
    guide.update({.path = out,
                  .map_from_robot = pose,
                  .still = box.map(),
                  .now = Time{Duration{66'666'667} * looks}});  // of 15 Hz
    const double before = pose.heading;
    bool drives = false, turned = false;
    while (guide.manoeuvre().active()) {
      const Twist2 twist = guide.manoeuvre().command(pose);
      turned = true;
      drives = drives || twist.v_mps != 0.0;
      const Vec2 step = direction(pose.heading) * (0.02 * twist.v_mps);
      pose = {pose.x + step.x, pose.y + step.y, pose.heading + 0.02 * twist.w_radps};
    }
    if (turned && !drives) turns.push_back(pose.heading - before);
  }
  CAPTURE(turns.size(), pose.x, pose.y, pose.heading);
  REQUIRE(turns.size() == 2);
  CHECK(turns[0] > 0.1);
  CHECK(turns[1] < -0.1);
}
