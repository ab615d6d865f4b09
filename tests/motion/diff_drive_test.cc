#include <limits>

#include "planner/motion/twist_ramp.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {
// Wheels of radius 0.1 m, 0.4 m apart, at most 10 rad/s: 1 m/s of rim.
const DiffDrive kDrive({.wheel_radius_m = 0.1, .track_width_m = 0.4, .max_wheel_speed_radps = 10.0});
}  // namespace

TEST_CASE("straight on both wheels turn alike: 0.5 m/s is 5 rad/s on a 10 cm wheel") {
  const WheelCommand c = kDrive.wheel_speeds({0.5, 0.0}, kNever);
  CHECK(c.left_radps == Approx(5.0));
  CHECK(c.right_radps == Approx(5.0));
}

TEST_CASE("turning left the right wheel leads: 1 rad/s over 0.2 m is 0.2 m/s of rim each way") {
  const WheelCommand c = kDrive.wheel_speeds({0.0, 1.0}, kNever);
  CHECK(c.left_radps == Approx(-2.0));
  CHECK(c.right_radps == Approx(2.0));
}

TEST_CASE("a twist beyond the motors keeps its curve and slows") {
  // v 1.0, w 2.5: rims 0.5 and 1.5 m/s, wheels 5 and 15 rad/s; scaled by 10/15 to 3.33 and 10.
  const WheelCommand c = kDrive.wheel_speeds({1.0, 2.5}, kNever);
  CHECK(c.left_radps == Approx(10.0 / 3.0));
  CHECK(c.right_radps == Approx(10.0));
}

TEST_CASE("a twist that is no number stands still") {
  const WheelCommand c = kDrive.wheel_speeds({std::numeric_limits<double>::quiet_NaN(), 0.0}, kNever);
  CHECK(c.left_radps == 0.0);
  CHECK(c.right_radps == 0.0);
}
