#include "planner/localization/odometry.h"

#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr DriveModel kDrive{.wheel_radius_m = 0.1, .track_width_m = 0.5, .max_wheel_speed_radps = 14.0};

WheelState reading(std::uint32_t k, double t_s, double left, double right, double speed_radps = 0.0) {
  return {.stamp = time_from_seconds(t_s),
          .sequence = k,
          .left_rad = left,
          .right_rad = right,
          .left_radps = speed_radps,
          .right_radps = speed_radps};
}

/// At rest at 0 s.
Odometry begun() {
  Odometry odometry(kDrive);
  (void)odometry.take(reading(1, 0.0, 0.0, 0.0));
  return odometry;
}

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

TEST_CASE("a quarter circle of radius 1 m ends at (1, 1) facing left") {
  // The left wheel rolls 0.75 pi/2 m, the right 1.25 pi/2 m; on wheels of 0.1 m ten times as many radians.
  Odometry odometry = begun();
  const ArcStep step = odometry.take(reading(2, 2.0, 7.5 * kPi / 2, 12.5 * kPi / 2));
  CHECK(step.distance_m == Approx(kPi / 2));
  CHECK(step.turn_rad == Approx(kPi / 2));
  CHECK(distance(odometry.odom_from_robot().position(), {1.0, 1.0}) < 1e-5);
  CHECK(odometry.odom_from_robot().heading == Approx(kPi / 2));
}

TEST_CASE("a scan between two readings is placed between them") {
  Odometry odometry = begun();
  (void)odometry.take(reading(2, 1.0, 10.0, 10.0));  // 1 m straight on
  CHECK(odometry.at(time_from_seconds(0.25)).x == Approx(0.25));
  CHECK(odometry.at(time_from_seconds(-5.0)).x == Approx(0.0));
}

TEST_CASE("a scan after the last reading is placed by its speed, for a quarter of a second at most") {
  Odometry odometry(kDrive);
  (void)odometry.take(reading(1, 0.0, 0.0, 0.0, 5.0));  // 0.5 m/s
  CHECK(odometry.at(time_from_seconds(0.05)).x == Approx(0.025));
  CHECK(odometry.at(time_from_seconds(10.0)).x == Approx(0.125));
}

TEST_CASE("wheels are silent after a quarter of a second, or two and a half of their own periods") {
  Odometry odometry(kDrive);
  CHECK(odometry.wheels_silent(time_from_seconds(0.0)));
  (void)odometry.take(reading(1, 0.0, 0.0, 0.0));
  CHECK_FALSE(odometry.wheels_silent(time_from_seconds(0.24)));
  CHECK(odometry.wheels_silent(time_from_seconds(0.26)));
  (void)odometry.take(reading(2, 0.5, 0.0, 0.0));
  CHECK_FALSE(odometry.wheels_silent(time_from_seconds(1.74)));
  CHECK(odometry.wheels_silent(time_from_seconds(1.76)));
}

TEST_CASE("after a silence in which nothing matched the wheels count on from before it, and the guess is forgotten") {
  Odometry odometry = begun();
  odometry.coast({0.6, 0.0, 0.0}, time_from_seconds(1.0));
  odometry.coast({0.6, 0.0, 0.0}, time_from_seconds(2.0));
  const WheelState back = reading(2, 2.1, 3.0, 3.0);  // it braked after 0.3 m
  CHECK(odometry.bridges(back));
  CHECK(odometry.take(back).distance_m == Approx(0.3));
  CHECK(odometry.odom_from_robot().x == Approx(0.3));
  CHECK(odometry.at(time_from_seconds(1.5)).x == Approx(0.3));
  CHECK_FALSE(odometry.bridges(reading(3, 2.2, 3.0, 3.0)));
}

TEST_CASE("counters that began anew in a silence do not bridge it") {
  Odometry odometry(kDrive);
  (void)odometry.take(reading(7, 0.0, 5.0, 5.0));
  odometry.coast({0.6, 0.0, 0.0}, time_from_seconds(1.0));
  CHECK_FALSE(odometry.bridges(reading(1, 1.1, 5.0, 5.0)));
  CHECK_FALSE(odometry.bridges(reading(8, 1.1, 5000.0, 5000.0)));
}

TEST_CASE("after a silence with matches the robot is where they put it, and the first reading goes by its speed") {
  Odometry odometry = begun();
  odometry.coast({0.6, 0.0, 0.0}, time_from_seconds(1.0));
  odometry.placed();
  CHECK_FALSE(odometry.by_wheels());
  // 0.6 m in all, that the robot has gone already, and 0.5 m/s.
  CHECK(odometry.take(reading(2, 1.1, 6.0, 6.0, 5.0)).distance_m == Approx(0.05));
  CHECK(odometry.by_wheels());
  CHECK(odometry.odom_from_robot().x == Approx(0.65));
  CHECK(odometry.take(reading(3, 1.2, 6.5, 6.5)).distance_m == Approx(0.05));
}

TEST_CASE("poses are known from the oldest remembered to a quarter of a second after the newest") {
  Odometry odometry(kDrive);
  CHECK(odometry.remembers(time_from_seconds(7.0)));  // nothing is known to be otherwise
  for (std::uint32_t k = 1; k <= 200; ++k) (void)odometry.take(reading(k, 0.02 * k, 0.0, 0.0));
  CHECK(odometry.remembers(time_from_seconds(1.5)));  // 128 poses: from 1.46 s on
  CHECK_FALSE(odometry.remembers(time_from_seconds(1.4)));
  CHECK(odometry.remembers(time_from_seconds(4.2)));
  CHECK_FALSE(odometry.remembers(time_from_seconds(4.3)));
}

TEST_CASE("encoders that restart or report nonsense do not move the robot") {
  Odometry odometry(kDrive);
  (void)odometry.take(reading(1, 0.00, 5000.0, 5000.0));
  (void)odometry.take(reading(2, 0.02, 0.0, 0.0));  // 500 m back in 20 ms
  CHECK(odometry.odom_from_robot() == Pose2{});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  (void)odometry.take(reading(3, 0.04, nan, nan));
  (void)odometry.take(reading(4, 0.06, 1.0, 1.0));
  CHECK(odometry.odom_from_robot() == Pose2{});
  (void)odometry.take(reading(5, 0.08, 1.2, 1.2));
  CHECK(odometry.odom_from_robot().x == Approx(0.02));
}

TEST_CASE("wheels that are known to pull to the left are put right, and their speed as well") {
  Odometry odometry(kDrive);
  odometry.set_radius_bias(0.1);
  (void)odometry.take(reading(1, 0.0, 0.0, 0.0));
  CHECK(odometry.take(reading(2, 4.0, 20.0, 20.0, 5.0)).turn_rad == Approx(0.2));  // 2 m: 0.2 rad
  CHECK(odometry.odom_from_robot().heading == Approx(0.2));
  CHECK(odometry.twist().w_radps == Approx(0.05));  // 0.5 m/s
}

TEST_CASE("a clock that is set back puts no scan where the robot was before") {
  for (const double back_s : {0.3, 0.9, 5.0}) {
    Odometry odometry(kDrive);
    for (std::uint32_t k = 0; k <= 50; ++k) (void)odometry.take(reading(k + 1, 0.02 * k, 0.2 * k, 0.2 * k));  // 1 m/s
    for (std::uint32_t k = 51; k <= 60; ++k) {
      (void)odometry.take(reading(k + 1, 0.02 * k - back_s, 0.2 * k, 0.2 * k));
      CHECK(odometry.at(time_from_seconds(0.02 * k - 0.003 - back_s)).x == Approx(0.02 * k).margin(0.02));
    }
    CHECK_FALSE(odometry.remembers(time_from_seconds(1.0 - back_s)));
  }
}

TEST_CASE("a speed that no motor has moves nobody after a silence, and none is left while they say nothing") {
  Odometry odometry(kDrive);
  (void)odometry.take(reading(1, 0.0, 0.0, 0.0, 5.0));
  odometry.coast({}, time_from_seconds(1.0));
  CHECK(odometry.at(time_from_seconds(1.2)).x == 0.0);
  CHECK(odometry.take(reading(1, 1.2, 0.0, 0.0, 1e6)).distance_m == 0.0);
}

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
