#include "planner/localization/odometry.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// After `scans` at 10 Hz on which the robot drove 0.05 m and turned 0.02 rad each; the last at (scans - 1)/10 s.
Coasting driven(int scans) {
  Coasting coasting;
  Pose2 there{3.0, -1.0, 0.7};
  for (int k = 0; k < scans; ++k) {
    coasting.placed(there, time_from_seconds(0.1 * k));
    there = there * Pose2{0.05, 0.0, 0.02};
  }
  return coasting;
}

}  // namespace

TEST_CASE("who was placed goes on as he went") {
  const Coasting coasting = driven(12);
  const Coasting::Step step = coasting.step(time_from_seconds(1.1), time_from_seconds(1.2));
  CHECK(step.before_from_after.x == Approx(0.05).epsilon(1e-3));  // a running mean, near its end
  CHECK(step.before_from_after.heading == Approx(0.02).epsilon(1e-3));
  CHECK(step.metres_std == Approx(0.015));  // 1.5 m/s^2 for 0.1 s
  CHECK(coasting.twist().v_mps == Approx(0.5).epsilon(1e-3));
}

TEST_CASE("before the first scan, after a long gap and where time goes backwards it stands") {
  CHECK(Coasting().step(kNever, time_from_seconds(5.0)).before_from_after == Pose2{});
  for (const double stamp_s : {1.0, 4.2}) {  // the last was at 1.1 s
    CHECK(driven(12).step(time_from_seconds(1.1), time_from_seconds(stamp_s)).before_from_after == Pose2{});
  }
}

TEST_CASE("the longer nobody looks the less is known of where it is") {
  const Coasting::Step two_seconds = driven(12).step(time_from_seconds(1.1), time_from_seconds(3.1));
  CHECK(two_seconds.before_from_after.x == Approx(1.0).epsilon(1e-3));  // 0.5 m/s
  CHECK(two_seconds.metres_std == Approx(6.0));                         // 1.5 m/s^2 for 2 s, twice
  CHECK(driven(12).step(time_from_seconds(1.1), time_from_seconds(11.1)).metres_std == Approx(13.5));
}

TEST_CASE("a step that no wheelchair drives tells no speed, and one that did not match a little less") {
  Coasting coasting = driven(12);
  coasting.not_placed({}, time_from_seconds(1.2));
  CHECK(coasting.twist().v_mps == Approx(0.4).epsilon(1e-3));
  coasting.placed({0.3, 0.0, 0.0}, time_from_seconds(1.3));  // 3 m/s
  CHECK(coasting.twist() == Twist2{});
}
