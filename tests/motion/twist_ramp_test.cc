#include "planner/motion/twist_ramp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Extremes {
  double top = 0.0, bottom = 0.0, accel = 0.0, jerk = 0.0, settled_s = 0.0;
};

Extremes ramp_to(Ramp& ramp, double target, double for_s) {
  constexpr double kDt = 0.02;
  Extremes seen;
  double v = ramp.velocity(), a = 0.0;
  for (double t = kDt; t < for_s; t += kDt) {
    const double next = ramp.toward(target, kDt);
    const double accel = (next - v) / kDt;
    seen.accel = std::max(seen.accel, std::fabs(accel));
    seen.jerk = std::max(seen.jerk, std::fabs(accel - a) / kDt);
    seen.top = std::max(seen.top, next);
    seen.bottom = std::min(seen.bottom, next);
    if (v != target && next == target) seen.settled_s = t;
    v = next, a = accel;
  }
  return seen;
}

}  // namespace

TEST_CASE("half the acceleration slows in time: v^2 = there^2 + 2 (a / 2) ahead") {
  CHECK(slowing_speed(0.0, 0.72, 0.5) == Approx(0.6));  // 0.36 = 0.5 * 0.72
  CHECK(slowing_speed(0.2, 0.64, 0.5) == Approx(0.6));  // 0.36 = 0.04 + 0.32
  CHECK(slowing_speed(0.2, 0.0, 0.5) == Approx(0.2));
}

TEST_CASE("0.6 m/s within 0.5 m/s2 and 2 m/s3 takes 1.45 s and overshoots by less than 0.2 mm/s") {
  // Trapezoid of acceleration: 0.6/0.5 + 0.5/2 = 1.45 s.
  Ramp ramp(0.5, 2.0);
  const Extremes seen = ramp_to(ramp, 0.6, 3.0);
  CHECK(ramp.velocity() == 0.6);
  CHECK(seen.top <= 0.6 + 2e-4);  // a fraction of a step: the formula is exact for whole ones
  CHECK(seen.accel <= 0.5 + 1e-9);
  CHECK(seen.jerk <= 2.0 + 1e-6);
  CHECK(seen.settled_s == Approx(1.45).margin(0.1));
}

TEST_CASE("slowing down from the middle of speeding up never goes below the target") {
  Ramp ramp(0.5, 2.0);
  ramp_to(ramp, 0.6, 0.6);
  const Extremes seen = ramp_to(ramp, 0.0, 3.0);
  CHECK(ramp.velocity() == 0.0);
  CHECK(seen.bottom >= -1e-12);
}

TEST_CASE("a ramp told of another speed goes on from there, from rest of acceleration") {
  Ramp ramp(0.5, 2.0);
  ramp_to(ramp, 0.6, 3.0);
  ramp.restart_at(0.2);
  CHECK(ramp.toward(0.6, 0.02) == Approx(0.2 + 2.0 * 0.02 * 0.02));  // jerk times dt squared
}

TEST_CASE("turning speeds up by the turn acceleration alone: 3 rad/s2 in 20 ms is 0.06 rad/s") {
  TwistRamp ramp({.max_accel_mps2 = 0.5, .max_turn_accel_radps2 = 3.0, .max_jerk_mps3 = 2.0});
  CHECK(ramp.toward({0.0, 1.0}, 0.02).w_radps == Approx(0.06));
  ramp.follow({0.0, 0.0});
  CHECK(ramp.toward({0.0, -1.0}, 0.02).w_radps == Approx(-0.06));
}

TEST_CASE("wheels turn as the twist has it, beyond the motors slower on the same curve, by no number not at all") {
  // Wheels of radius 0.1 m, 0.4 m apart, at most 10 rad/s: 1 m/s of rim.
  const DriveModel drive{.wheel_radius_m = 0.1, .track_width_m = 0.4, .max_wheel_speed_radps = 10.0};
  struct Row {
    const char* name;
    Twist2 twist;
    double left_radps, right_radps;
  };
  const Row rows[] = {{"0.5 m/s straight on is 5 rad/s on a 10 cm wheel", {0.5, 0.0}, 5.0, 5.0},
                      {"1 rad/s over 0.2 m is 0.2 m/s of rim each way", {0.0, 1.0}, -2.0, 2.0},
                      {"rims of 0.5 and 1.5 m/s: 5 and 15 rad/s, times 10/15", {1.0, 2.5}, 10.0 / 3.0, 10.0},
                      {"no number", {std::numeric_limits<double>::quiet_NaN(), 0.0}, 0.0, 0.0}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    const WheelCommand command = wheel_speeds(drive, row.twist, kNever);
    CHECK(command.left_radps == Approx(row.left_radps));
    CHECK(command.right_radps == Approx(row.right_radps));
  }
}
