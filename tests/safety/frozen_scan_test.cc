#include "firmware/safety/frozen_scan.h"

#include <cmath>
#include <limits>

#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Scans of ten beams, and wheels of 0.0975 m that roll 0.024 m a scan.
struct Scanner {
  FrozenScan frozen{p3dx().drive};
  LaserScan scan;
  WheelState wheels;

  Scanner() {
    scan.beam_count = 10;
    scan.range_min_m = 0.05F;
    scan.range_max_m = 25.0F;
    scan.range_m.fill(2.0F);
  }
  /// The next scan, the same but for one range.
  bool next(float range_m, double rolled_m = 0.024) {
    scan.sequence += 1;
    scan.range_m[3] = range_m;
    wheels.sequence += 1;
    wheels.left_rad += rolled_m / p3dx().drive.wheel_radius_m;
    return frozen.is_frozen(scan, wheels);
  }
};

}  // namespace

TEST_CASE("the same scan again and again is noticed once a wheel has rolled a tenth of a metre") {
  Scanner scanner;
  CHECK_FALSE(scanner.next(4.0F));
  for (int k = 0; k < 4; ++k) CHECK_FALSE(scanner.next(4.0F));  // 0.096 m
  CHECK(scanner.next(4.0F));
  CHECK(scanner.next(4.0F, 0.0));  // and stays so when the robot stands
  CHECK_FALSE(scanner.next(4.001F));
}

TEST_CASE("one millimetre in one beam tells a scanner that works, and so does a robot that stands") {
  Scanner driving, standing;
  for (int k = 0; k < 100; ++k) CHECK_FALSE(driving.next(k % 2 == 0 ? 4.0F : 4.001F));
  for (int k = 0; k < 100; ++k) CHECK_FALSE(standing.next(4.0F, 0.0));
}

TEST_CASE("two scans alike are chance, however far the wheels roll") {
  Scanner scanner;
  for (int k = 0; k < 100; ++k) CHECK_FALSE(scanner.next(k / 2 % 2 == 0 ? 4.0F : 4.001F, 0.3));
}

TEST_CASE("where nothing is in reach scans are alike for good reason") {
  Scanner scanner;
  scanner.scan.range_m.fill(std::numeric_limits<float>::infinity());
  for (int k = 0; k < 100; ++k) CHECK_FALSE(scanner.next(std::numeric_limits<float>::infinity()));
}

TEST_CASE("between scans nothing is counted") {
  Scanner scanner;
  CHECK_FALSE(scanner.next(4.0F));
  for (int k = 0; k < 100; ++k) {
    scanner.wheels.left_rad += 1.0;
    CHECK_FALSE(scanner.frozen.is_frozen(scanner.scan, scanner.wheels));
  }
}
