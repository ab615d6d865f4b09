#include "planner/localization/odometry_noise.h"

#include <cmath>
#include <memory>

#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// A metre at a time, each seen to be right.
void drive_right(OdometryNoiseEstimator& trust, int metres) {
  for (int k = 0; k < metres; ++k) trust.drove({1.0, 0.0}), trust.corrected({}, {});
}

OdometryNoiseEstimator trusted() {
  OdometryNoiseEstimator trust;
  trust.corrected({}, {});
  drive_right(trust, 120);
  return trust;
}

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
    return watch.match(sample_of(points), tracker.still(), {said, kSure, kUnknown, learnt, coasted});
  }

  Room room = rectangle(8.0, 6.0);
  Tracker tracker{{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}};
  ScanPoints points;
  SlipDetector watch;
  PoseBelief coasted{{}, kSure};
};

double off(const MatchResult& found) { return norm(found.belief.map_from_robot.position()); }

}  // namespace

TEST_CASE("wheels that the map never corrects are doubted half as much from window to window, down to a bound") {
  // Unknown wheels: (0.035 rad)^2 a metre, so that the ninth metre ends a window of (0.1 rad)^2.
  OdometryNoiseEstimator trust;
  trust.corrected({}, {});
  drive_right(trust, 8);
  CHECK(trust.turns() == 1.0);
  CHECK(trust.nothing_known());
  drive_right(trust, 1);
  CHECK(trust.turns() == Approx(0.5));
  CHECK(trust.metres() == Approx(0.5));
  CHECK_FALSE(trust.nothing_known());
  drive_right(trust, 9);
  CHECK(trust.turns() == Approx(0.25));
  drive_right(trust, 900);
  CHECK(trust.turns() == Approx(OdometryNoiseEstimator::kLeastShare));
  CHECK(trust.metres() == Approx(OdometryNoiseEstimator::kLeastShare));
}

TEST_CASE("trusted wheels are doubted again as soon as the map turns them by more than it may be wrong itself") {
  OdometryNoiseEstimator trust = trusted();
  trust.corrected({}, {0.0, 0.0, 0.0045});  // a quarter of a degree
  CHECK(trust.turns() == Approx(OdometryNoiseEstimator::kLeastShare));
  trust.corrected({}, {0.0, 0.0, 0.0045});  // with the one before (0.009^2 - 0.005^2) / 0.1^2
  CHECK(trust.turns() == Approx(0.0056));
  trust.corrected({}, {0.0, 0.0, 0.091});  // (0.1^2 - 0.005^2) / 0.1^2
  CHECK(trust.turns() == Approx(0.9975));
  CHECK(trust.metres() ==
        Approx(std::sqrt(0.9975 * OdometryNoiseEstimator::kLeastShare)));  // as metres, they were right
}

TEST_CASE("wheels that count metres wrong are doubted for it, and less for their turns") {
  OdometryNoiseEstimator trust = trusted();
  trust.corrected({3.0, 0.0, 0.0}, {3.1, 0.0, 0.0});
  trust.corrected({4.0, 0.0, 0.0}, {4.1, 0.0, 0.0});
  const double metres_alone = (0.2 * 0.2 - 0.03 * 0.03) / 2.0 / (0.14 * 0.14);
  CHECK(trust.metres() == Approx(metres_alone));
  CHECK(trust.turns() == Approx(std::sqrt(metres_alone * OdometryNoiseEstimator::kLeastShare)));
}

TEST_CASE("what a match puts right after the pose was moved by something else is not the wheels' fault") {
  OdometryNoiseEstimator trust = trusted();
  trust.begin_anew();
  trust.corrected({}, {0.2, 0.0, 0.1});
  CHECK(trust.turns() == Approx(OdometryNoiseEstimator::kLeastShare));
  trust.corrected({}, {0.2, 0.0, 0.1});
  CHECK(trust.turns() > 0.9);
}

TEST_CASE("a pull to one side is learnt from what matches put right, and no more than is sensible") {
  WheelRadiusBias drift;
  for (int k = 0; k < 100; ++k) {  // 10 m; the robot turns right by 0.05 rad a metre where its wheels say straight on
    drift.drove({0.1, 0.0});
    drift.corrected(0.1 * (-0.05 - drift.turn_per_m()));
  }
  CHECK(drift.turn_per_m() == Approx(-0.05).margin(0.01));
  for (int k = 0; k < 1000; ++k) drift.drove({0.1, 0.0}), drift.corrected(0.02);
  CHECK(drift.turn_per_m() == WheelRadiusBias::kMost);
  const double before = drift.turn_per_m();
  drift.drove({0.0, 1.0});  // on the spot: says nothing of metres
  drift.corrected(0.5);
  CHECK(drift.turn_per_m() == before);
}

TEST_CASE("a wheel that spins in the air for a second pulls to no side afterwards") {
  for (const double turn_rad : {0.073, -0.04}) {  // a scan: five and three times what the greatest pull turns it by
    WheelRadiusBias drift;
    for (int k = 0; k < 15; ++k) drift.drove({0.04, 0.0}), drift.corrected(turn_rad);
    CHECK(drift.turn_per_m() == 0.0);
  }
}

TEST_CASE("metres before the pose was moved by something else say nothing of the side that wheels pull to") {
  WheelRadiusBias drift, told;
  const auto learn = [](WheelRadiusBias& d) {
    for (int k = 0; k < 20; ++k) d.drove({0.1, 0.0}), d.corrected(0.1 * (0.05 - d.turn_per_m()));
  };
  for (WheelRadiusBias* d : {&drift, &told}) learn(*d), d->drove({10.0, 0.0});
  told.begin_anew();  // a fix put the heading right: the next match finds nothing to turn
  for (WheelRadiusBias* d : {&drift, &told}) d->corrected(0.0), learn(*d);
  CHECK(told.turn_per_m() > 0.04);
  CHECK(drift.turn_per_m() < 0.04);
}

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
  CHECK_FALSE(
      robot->watch.match(sample_of(robot->points), robot->tracker.still(), {{}, none, none, true, {{}, none}}).matched);
}
