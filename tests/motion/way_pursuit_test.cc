// A wheelchair along the way that its pose guide has.
#include <memory>

#include "planner/motion/proposals.h"
#include "tests/motion/chair.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;
using tests::Chair;
using tests::WalledGround;

namespace {

struct Followed {
  RobotState end;
  float least_room_m = 1e9F, slowest = 0.0F;
  int steps = 0;
};

/// From rest until the way ends, for a minute at most.
Followed follow(Chair& chair, const Pose2& start, Vec2 goal, double heading = kAnyHeading) {
  const RobotModel model = wheelchair();
  const RobotBody body = robot_body(model.footprint, model.limits, model.laser, 1.0);
  const auto nobody = std::make_unique<Futures>();
  const NearReturns no_returns;
  Followed done;
  RobotState robot{static_cast<float>(start.x), static_cast<float>(start.y), static_cast<float>(start.heading)};
  for (; done.steps < 600; ++done.steps) {
    const Pose2 here{static_cast<double>(robot.x), static_cast<double>(robot.y), static_cast<double>(robot.heading)};
    CAPTURE(here.x, here.y, here.heading, robot.v, robot.w, done.steps, done.least_room_m);
    REQUIRE(chair.from(here, goal, heading).known);
    const Place place{static_cast<float>(goal.x), static_cast<float>(goal.y)};
    Situation s{{robot, place}, body, chair.guide, *nobody, no_returns, 0.24F};
    s.poses = &chair.poses;
    s.wants_heading = std::isfinite(heading);
    s.goal_heading = s.wants_heading ? static_cast<float>(heading) : 0.0F;
    WayPursuit pursuit(s, robot);
    if (!pursuit.has_more(robot)) break;
    const Command command = pursuit.command(robot, 0.6F);
    robot = moved(robot, command, body.bounds, 0.1F);
    done.least_room_m = std::min(
        done.least_room_m, body.outline.clearance(chair.guide, robot.x, robot.y, cell::heading_at(robot.heading)));
    done.slowest = std::min(done.slowest, robot.v);
    const float dx = robot.x - s.goal.x, dy = robot.y - s.goal.y;
    const bool faces = !s.wants_heading || std::fabs(cell::wrapped(robot.heading - s.goal_heading)) < 0.05F;
    if (dx * dx + dy * dy < 0.22F * 0.22F && faces) break;  // 0.9 of 0.24
  }
  done.end = robot;
  return done;
}

}  // namespace

TEST_CASE("along its way a wheelchair comes through a door of 0.90 m, and stands at the goal as wanted") {
  const WalledGround ground = WalledGround().wall({2.03, -3.9}, {2.03, -0.45}).wall({2.03, 0.45}, {2.03, 3.9});
  const double y = GENERATE(-0.8, 0.0, 0.8);
  Chair chair(ground);
  const Followed done = follow(chair, {0.6, y, 0.7}, {3.2, 0.1}, -0.5);
  CAPTURE(y, done.end.x, done.end.y, done.end.heading, done.steps);
  CHECK(done.steps < 250);
  CHECK(done.least_room_m > 0.0F);
  CHECK(done.end.heading == Approx(-0.5).margin(0.06));
}

TEST_CASE("along its way it comes out of a dead end, and backs no faster than it may") {
  const WalledGround ground = WalledGround()
                                  .wall({1.0, -0.6}, {1.0, 0.6})
                                  .wall({-3.9, -0.6}, {1.0, -0.6})
                                  .wall({-1.5, 0.6}, {1.0, 0.6})
                                  .wall({-1.5, 0.6}, {-1.5, 4.0});
  Chair chair(ground);
  const Followed done = follow(chair, {0.0, 0.0, 0.0}, {-2.6, 2.0});
  CHECK(done.steps < 400);
  CHECK(done.least_room_m > 0.0F);
  CHECK(done.slowest < -0.1F);
  CHECK(done.slowest > -0.301F);
}
