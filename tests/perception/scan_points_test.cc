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

}  // namespace

TEST_CASE("points are taken from the laser to the robot") {
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(three_beams(), {0.5, 0.0, kPi / 2}, {}, *points);  // 0.5 m ahead of the axle, looking left
  REQUIRE(points->size() == 3);
  CHECK((*points)[0].in_robot.x == Approx(1.5));  // the laser's right is the robot's ahead
  CHECK((*points)[0].in_robot.y == Approx(0.0).margin(1e-6));
  CHECK((*points)[1].in_robot.x == Approx(0.5));
  CHECK((*points)[1].in_robot.y == Approx(2.0));
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
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan, {}, {}, *points);
  CHECK(points->empty());
  scan.range_max_m = std::numeric_limits<float>::infinity();
  scan.range_m[1] = 1e30F;  // no laser measures that far, whatever its limits claim
  ScanProjection().project(scan, {}, {}, *points);
  CHECK(points->empty());
}

TEST_CASE("angles that are no fan give no points") {
  const auto points = std::make_unique<ScanPoints>();
  LaserScan scan = three_beams();
  scan.first_angle_rad = 1e38F;
  ScanProjection().project(scan, {}, {}, *points);
  CHECK(points->empty());
  scan = three_beams();
  scan.angle_step_rad = std::numeric_limits<float>::quiet_NaN();
  ScanProjection().project(scan, {}, {}, *points);
  CHECK(points->empty());
}

TEST_CASE("more beams than there is room for are cut off") {
  LaserScan scan = three_beams();
  scan.beam_count = 1000000;
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan, {}, {}, *points);
  CHECK(points->size() == 3);
}

TEST_CASE("a sweep of a turning robot is put right") {
  LaserScan scan = three_beams();
  scan.sweep = duration_from_seconds(0.2);
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan, {}, {0.0, kPi / 2}, *points);  // 90 degrees a second
  // The last beam, 3 m to the left, was measured 0.2 s later: 18 degrees farther round.
  CHECK((*points)[0].in_robot.y == Approx(-1.0));
  CHECK((*points)[2].in_robot.x == Approx(3.0 * jaywalk::cos(108.0 * kPi / 180.0)));
  CHECK((*points)[2].in_robot.y == Approx(3.0 * jaywalk::sin(108.0 * kPi / 180.0)));
}

TEST_CASE("a sweep of a driving robot is put right") {
  LaserScan scan = three_beams();
  scan.sweep = duration_from_seconds(0.2);
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan, {}, {1.0, 0.0}, *points);
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
  CHECK((*points)[1].in_robot.x == Approx(0.2));
  CHECK((*points)[1].in_robot.y == Approx(4.0));
  CHECK((*points)[1].beam == 2);
}
