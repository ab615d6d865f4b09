#include "planner/scan/scan_points.h"
#include "tests/support/catch.h"

using namespace jaywalk;

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
