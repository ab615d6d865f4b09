#include "hal/robot_model_file.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("no comfort profile is faster than the file, brakes otherwise, or plans more than SAFETY permits") {
  RobotModel quick = p3dx(), sporty = p3dx();
  quick.limits.max_accel_mps2 = 0.9;
  sporty.limits.max_accel_mps2 = 1.3;
  for (const RobotModel& model : {p3dx(), wheelchair(), quick, sporty}) {
    for (const Comfort comfort : {Comfort::kGentle, Comfort::kNormal, Comfort::kBrisk}) {
      const MotionLimits limits = limits_for(comfort, model);
      CHECK(limits.max_speed_mps <= model.limits.max_speed_mps);
      CHECK(limits.max_turn_radps <= model.limits.max_turn_radps);
      CHECK(limits.brake_mps2 == model.limits.brake_mps2);
      CHECK(limits.max_accel_mps2 <= std::max(1.0, model.limits.max_accel_mps2));
      CHECK(limits.max_jerk_mps3 <= 2.0);
    }
  }
}

TEST_CASE("gentle is slower and softer and keeps farther off, brisk is quicker and goes nearer") {
  const RobotModel model = p3dx();  // 0.6 m/s, 0.5 m/s2, 2 m/s3
  const MotionLimits gentle = limits_for(Comfort::kGentle, model), brisk = limits_for(Comfort::kBrisk, model);
  CHECK(gentle.max_speed_mps == Approx(0.39));
  CHECK(gentle.max_accel_mps2 == Approx(0.3));
  CHECK(gentle.max_jerk_mps3 == Approx(1.2));
  CHECK(brisk.max_speed_mps == Approx(0.6));
  CHECK(brisk.max_accel_mps2 == Approx(0.8));
  CHECK(profile_of(Comfort::kGentle).comfort_distance_m > profile_of(Comfort::kNormal).comfort_distance_m);
  CHECK(profile_of(Comfort::kBrisk).comfort_distance_m < profile_of(Comfort::kNormal).comfort_distance_m);
}
