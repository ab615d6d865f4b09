#include "firmware/safety/blind_gaps.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;

/// A scan all round (or less) whose beams are a degree apart and find nothing, but for those that are lost.
LaserScan scan_without(int first_lost, int lost, int beams = 360, double turns = 1.0) {
  LaserScan scan;
  scan.sequence = 1;
  scan.beam_count = static_cast<std::uint32_t>(beams);
  scan.first_angle_rad = static_cast<float>(-0.5 * turns * beams * kDeg);
  scan.angle_step_rad = static_cast<float>(turns * kDeg);
  scan.range_min_m = 0.05F;
  scan.range_max_m = 10.0F;
  scan.range_m.fill(std::numeric_limits<float>::infinity());
  for (int k = first_lost; k < first_lost + lost; ++k)
    scan.range_m[static_cast<std::size_t>((k + beams) % beams)] = 0.0F;
  return scan;
}

Coverage at(const LaserScan& scan, double way_deg, double range_m, const LaserModel& laser = p3dx().laser) {
  BlindGaps gaps(laser);
  gaps.update(scan);
  return gaps.at(direction(way_deg * kDeg) * range_m);
}

}  // namespace

TEST_CASE("a post of 70 mm hides behind five lost beams of a degree from 0.67 m on: 0.035 / sin 3 deg") {
  const LaserScan scan = scan_without(198, 5);  // 18 to 22 degrees; their neighbours at 17 and 23
  // Its middle from 0.6688 m on, its front 35 mm before that.
  CHECK(at(scan, 20.0, 0.63) == Coverage::kProven);
  CHECK(at(scan, 20.0, 0.64) == Coverage::kLost);
  CHECK(at(scan, 17.1, 3.0) == Coverage::kLost);
  CHECK(at(scan, 22.9, 3.0) == Coverage::kLost);
  CHECK(at(scan, 16.9, 3.0) == Coverage::kProven);
  CHECK(at(scan, 23.1, 3.0) == Coverage::kProven);
  BlindGaps gaps(p3dx().laser);
  gaps.update(scan);
  CHECK(gaps.nearest_lost_m() == Approx(0.6338).epsilon(1e-3));
  CHECK(gaps.counts().lost == 5);
  CHECK(gaps.counts().measured == 355);
}

TEST_CASE("a gap over the seam of a scan all round is one gap, whichever way the scanner turns") {
  const double turns = GENERATE(1.0, -1.0);
  const LaserScan scan = scan_without(-3, 5, 360, turns);
  CHECK(at(scan, 180.0 - turns * 1.0, 0.63) == Coverage::kProven);
  CHECK(at(scan, 180.0 - turns * 1.0, 0.64) == Coverage::kLost);
  CHECK(at(scan, -179.0, 1.0) == Coverage::kLost);
  CHECK(at(scan, 90.0, 5.0) == Coverage::kProven);
}

TEST_CASE("a gap at the rim of the view has one neighbour, and beyond the rim nothing watches") {
  const LaserScan scan = scan_without(0, 3, 181);  // -90.5 to 89.5 degrees; lost as far as -87.5
  // 0.035 / sin 3 deg, as for six degrees between two neighbours.
  CHECK(at(scan, -89.0, 0.63) == Coverage::kProven);
  CHECK(at(scan, -89.0, 0.64) == Coverage::kLost);
  CHECK(at(scan, -92.0, 0.3) == Coverage::kUnwatched);
  CHECK(at(scan, 180.0, 0.3) == Coverage::kUnwatched);
  CHECK(at(scan, 91.0, 0.3) == Coverage::kUnwatched);
  CHECK(at(scan, 88.0, 3.0) == Coverage::kProven);
}

TEST_CASE("a blanked sector is unwatched, whatever its beams say, and what is lost beside it is lost") {
  LaserModel laser = p3dx().laser;
  (void)laser.blanked.push_back({17.5 * kDeg, 22.5 * kDeg});
  CHECK(at(scan_without(0, 0), 20.0, 1.0, laser) == Coverage::kUnwatched);
  CHECK(at(scan_without(0, 0), 20.0, 0.6, laser) == Coverage::kProven);
  CHECK(at(scan_without(198, 5), 20.0, 1.0, laser) == Coverage::kUnwatched);
  const LaserScan beside = scan_without(203, 2);  // 23 and 24 degrees: with the sector 8 degrees from 17 to 25
  CHECK(at(beside, 24.0, 0.45, laser) == Coverage::kProven);
  CHECK(at(beside, 24.0, 0.48, laser) == Coverage::kLost);
  CHECK(at(beside, 20.0, 0.48, laser) == Coverage::kUnwatched);
}

TEST_CASE("where no beam measured all is lost, without directions nothing is watched") {
  LaserScan scan = scan_without(0, 360);
  CHECK(at(scan, 20.0, 0.1) == Coverage::kLost);
  scan.angle_step_rad = std::nanf("");
  CHECK(at(scan, 20.0, 0.1) == Coverage::kUnwatched);
}
