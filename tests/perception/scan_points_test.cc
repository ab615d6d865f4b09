#include "planner/scan/scan_points.h"

#include <limits>
#include <memory>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

LaserScan three_beams() {  // right, ahead, left
  LaserScan scan;
  scan.beam_count = 3;
  scan.first_angle_rad = static_cast<float>(-kPi / 2);
  scan.angle_step_rad = static_cast<float>(kPi / 2);
  scan.range_min_m = 0.05F;
  scan.range_max_m = 10.0F;
  scan.range_m = {1.0F, 2.0F, 3.0F};
  return scan;
}

std::unique_ptr<ScanPoints> points_of(const LaserScan& scan, const Pose2& robot_from_laser = {},
                                      const Twist2& twist = {}) {
  auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan, robot_from_laser, twist, *points);
  return points;
}

}  // namespace

TEST_CASE("points are taken from the laser to the robot") {
  const auto points = points_of(three_beams(), {0.5, 0.0, kPi / 2});  // 0.5 m ahead of the axle, looking left
  REQUIRE(points->size() == 3);
  CHECK(distance((*points)[0].in_robot, {1.5, 0.0}) < 1e-6);  // the laser's right is the robot's ahead
  CHECK(distance((*points)[1].in_robot, {0.5, 2.0}) < 1e-6);
  CHECK((*points)[2].in_robot.x == Approx(-2.5));
}

TEST_CASE("beams that look elsewhere than the scan before, or are more, give points where they look") {
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection projection;
  LaserScan scan = three_beams();
  scan.beam_count = 2;
  projection.project(scan, {}, {}, *points);
  CHECK((*points)[1].in_robot.x == Approx(2.0));
  scan.beam_count = 3;
  projection.project(scan, {}, {}, *points);
  CHECK((*points)[2].in_robot.y == Approx(3.0));
  scan.angle_step_rad = static_cast<float>(kPi);  // right, left, right
  projection.project(scan, {}, {}, *points);
  CHECK((*points)[1].in_robot.y == Approx(2.0));
  CHECK((*points)[2].in_robot.y == Approx(-3.0));
  scan.first_angle_rad = 0.0F;  // ahead, behind, ahead
  projection.project(scan, {}, {}, *points);
  CHECK((*points)[1].in_robot.x == Approx(-2.0));
}

TEST_CASE("beams without a return are left out") {
  LaserScan scan = three_beams();
  scan.range_m = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.0F};
  CHECK(points_of(scan)->empty());
  scan.range_max_m = std::numeric_limits<float>::infinity();
  scan.range_m[1] = 1e30F;  // no laser measures that far, whatever its limits claim
  CHECK(points_of(scan)->empty());
}

TEST_CASE("angles that are no fan give no points") {
  LaserScan far = three_beams(), none = far;
  far.first_angle_rad = 1e38F;
  none.angle_step_rad = std::numeric_limits<float>::quiet_NaN();
  CHECK(points_of(far)->empty());
  CHECK(points_of(none)->empty());
}

TEST_CASE("more beams than there is room for are cut off") {
  LaserScan scan = three_beams();
  scan.beam_count = 1000000;
  CHECK(points_of(scan)->size() == 3);
}

TEST_CASE("a sweep of a robot that turns or drives is put right") {
  LaserScan scan = three_beams();
  scan.sweep = duration_from_seconds(0.2);
  auto points = points_of(scan, {}, {0.0, kPi / 2});  // 90 degrees a second
  // The last beam, 3 m to the left, was measured 0.2 s later: 18 degrees farther round.
  CHECK((*points)[0].in_robot.y == Approx(-1.0));
  CHECK(distance((*points)[2].in_robot, direction(108.0 * kPi / 180.0) * 3.0) < 1e-5);
  points = points_of(scan, {}, {1.0, 0.0});
  CHECK((*points)[1].in_robot.x == Approx(2.1));  // measured after 0.1 s, 0.1 m on
  CHECK((*points)[2].in_robot.x == Approx(0.2));
}

TEST_CASE(
    "beams without a return are projected to a given range and corrected for motion, unknown beams are left out") {
  LaserScan scan = three_beams();
  scan.sweep = duration_from_seconds(0.2);
  scan.range_m = {0.0F, std::numeric_limits<float>::infinity(), 10.0F};
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project_empty(scan, {}, {1.0, 0.0}, 4.0, *points);
  REQUIRE(points->size() == 2);
  CHECK((*points)[0].in_robot.x == Approx(4.1));
  CHECK(distance((*points)[1].in_robot, {0.2, 4.0}) < 2e-6);
  CHECK((*points)[1].beam == 2);
}

TEST_CASE("scans of a robot that drives before its speed is known are unreliable for a second") {
  FirstScans scans;
  CHECK_FALSE(scans.are_unreliable({0.0, 0.0}, time_from_seconds(0.0)));
  CHECK(scans.are_unreliable({0.6, 0.0}, time_from_seconds(0.1)));
  CHECK(scans.are_unreliable({0.8, 0.0}, time_from_seconds(0.2)));  // 0.2 m/s is what a robot may gain
  CHECK(scans.are_unreliable({0.8, 0.0}, time_from_seconds(1.0)));
  CHECK_FALSE(scans.are_unreliable({0.8, 0.0}, time_from_seconds(1.1)));
}

TEST_CASE("a robot that turns misleads likewise, and one that sets out does not") {
  FirstScans turning, starting;
  CHECK_FALSE(turning.are_unreliable({0.0, 0.0}, time_from_seconds(0.0)));
  CHECK(turning.are_unreliable({0.0, -0.4}, time_from_seconds(0.1)));
  for (int k = 0; k < 10; ++k) CHECK_FALSE(starting.are_unreliable({0.1 * k, 0.2 * k}, time_from_seconds(0.1 * k)));
}

TEST_CASE("later jumps are slips and stops of a robot whose speed is known") {
  FirstScans scans;
  for (int k = 0; k < 4; ++k) CHECK_FALSE(scans.are_unreliable({1.0, 0.0}, time_from_seconds(0.1 * k)));
  CHECK_FALSE(scans.are_unreliable({0.0, 0.0}, time_from_seconds(0.4)));
}
