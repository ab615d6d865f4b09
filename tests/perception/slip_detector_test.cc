#include <cmath>
#include <memory>

#include "planner/localization/odometry_noise.h"
#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

const Eigen::Matrix3d kSure = diagonal(1e-6, 1e-6, 1e-6);  // a millimetre, 0.06 degrees
const Eigen::Matrix3d kUnknown = diagonal(0.01, 0.01, 0.01);

/// A room of 8 m by 6 m that was seen from its middle for two seconds; the robot is there, and its wheels say that it
/// has come 0.15 m ahead and turned by 0.1 rad.
struct SpunWheels {
  SpunWheels() {
    for (std::uint32_t k = 1; k <= 30; ++k) tracker.update(scan_of(room, {}, k), {});
  }
  MatchResult match(const Pose2& said, bool learnt, std::uint32_t scan) {
    ScanProjection().project(scan_of(room, {}, scan), {}, {}, points);
    return watch.match(points, tracker.still(), {said, kSure, kUnknown, learnt, coasted});
  }

  Room room = rectangle(8.0, 6.0);
  Tracker tracker{{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}};
  ScanPoints points;
  SlipDetector watch;
  PoseBelief coasted{{}, kSure};
};

double off(const MatchResult& found) { return norm(found.belief.map_from_robot.position()); }

}  // namespace

TEST_CASE("wheels that are believed to a millimetre are not followed away from walls that were matched before") {
  const auto robot = std::make_unique<SpunWheels>();
  for (std::uint32_t k = 31; k < 61; ++k) REQUIRE(off(robot->match({}, true, k)) < 0.01);
  const MatchResult found = robot->match({0.15, 0.0, 0.1}, true, 61);
  CHECK(found.matched);
  CHECK(off(found) < 0.02);
  CHECK(found.belief.map_from_robot.heading == Approx(0.0).margin(0.01));
}

TEST_CASE("without matches before nothing says that well-known wheels slipped, and unknown ones are not followed") {
  const auto robot = std::make_unique<SpunWheels>();
  CHECK(off(robot->match({0.15, 0.0, 0.1}, true, 31)) > 0.1);
  CHECK(off(robot->match({0.15, 0.0, 0.1}, false, 31)) < 0.02);
}

TEST_CASE("where the wheels are off by more than they may slip the way it went before is tried") {
  for (const bool went_on : {true, false}) {
    const auto robot = std::make_unique<SpunWheels>();
    for (std::uint32_t k = 31; k < 61; ++k) REQUIRE(off(robot->match({}, true, k)) < 0.01);
    if (!went_on) robot->coasted.map_from_robot = {2.0, 1.0, 1.0};       // which is no better
    const MatchResult found = robot->match({0.15, 0.0, 0.6}, true, 61);  // three standard deviations are 0.3 rad
    CHECK((found.matched && off(found) < 0.02 && std::fabs(found.belief.map_from_robot.heading) < 0.01) == went_on);
  }
}

TEST_CASE("a belief that no numbers can hold is no match") {
  const auto robot = std::make_unique<SpunWheels>();
  ScanProjection().project(scan_of(robot->room, {}, 31), {}, {}, robot->points);
  const Eigen::Matrix3d none = diagonal(0.0, 0.0, 0.0);  // its inverse is infinite
  CHECK_FALSE(robot->watch.match(robot->points, robot->tracker.still(), {{}, none, none, true, {{}, none}}).matched);
}
