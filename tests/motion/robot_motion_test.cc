#include "planner/motion/robot_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/catch.h"

using namespace jaywalk::motion;

namespace {

constexpr MotionBounds kBounds{.speed = 0.6F,
                               .back = 0.3F,
                               .turn = 1.2F,
                               .turn_accel = 2.0F,
                               .accel = 0.5F,
                               .slowing = 0.8F,
                               .jerk = 2.0F,
                               .brake = 1.0F};

}  // namespace

TEST_CASE("a command is reached within acceleration and jerk, and not overshot") {
  const float to = GENERATE(0.6F, 0.1F, -0.3F, 0.013F);
  RobotState s;
  float accel = 0.0F;
  for (int k = 0; k < 200; ++k) {
    const RobotState next = moved(s, {to, 0.0F}, kBounds, 0.02F);
    CHECK(std::fabs(next.accel) <= 0.8F + 1e-5F);
    CHECK(std::fabs(next.accel - accel) <= 2.0F * 0.02F + 1e-5F);
    CHECK(std::fabs(next.v) <= std::fabs(to) + 1e-6F);
    accel = next.accel;
    s = next;
  }
  CHECK(s.v == to);
}

TEST_CASE("commands that change under way are followed within acceleration and jerk, the way to rest included") {
  constexpr std::array<float, 7> kTo{0.6F, 0.2F, 0.4F, -0.3F, 0.5F, 0.0F, 0.35F};
  for (int hold = 5; hold < 60; ++hold) {  // ticks
    RobotState s;
    for (int k = 0; k < 600; ++k) {
      const RobotState next = moved(s, {kTo[static_cast<std::size_t>(k / hold) % kTo.size()], 0.0F}, kBounds, 0.02F);
      const float accel = (next.v - s.v) / 0.02F;
      CHECK(std::fabs(accel - s.accel) <= 2.0F * 0.02F + 0.01F);
      CHECK(std::fabs(next.v) < 0.66F);
      s = next;
      s.accel = accel;
    }
  }
}

TEST_CASE("braking as hard as it can takes 1 m/s2 from the first tick on, and is let go at once") {
  RobotState s{.v = 0.6F, .accel = 0.3F};
  float way_m = 0.0F;
  for (int k = 1; k <= 30; ++k) {
    s = moved(s, {0.0F, 0.0F, true}, kBounds, 0.02F);
    CHECK(s.v == Approx(0.6F - 0.02F * static_cast<float>(k)).margin(1e-5));
    CHECK(s.accel == 0.0F);
    way_m += 0.02F * s.v;
  }
  CHECK(s.v == Approx(0.0F).margin(1e-6));
  CHECK(way_m == Approx(0.174F).margin(0.002));  // 0.36 / 2, and half a tick less
  CHECK(moved(s, {0.0F, 0.0F, true}, kBounds, 0.02F).v == 0.0F);
  const RobotState rests = moved(s, {0.0F, 0.0F, true}, kBounds, 0.02F),
                   on = moved(rests, {0.6F, 0.0F}, kBounds, 0.02F);
  CHECK(on.v == Approx(2.0F * 0.02F * 0.02F));  // as from rest
  RobotState slower{.v = 0.6F};
  for (int k = 0; k < 40; ++k) slower = moved(slower, {0.3F, 0.0F, k < 20}, kBounds, 0.02F);
  CHECK(slower.v == 0.3F);
  CHECK(moved({.v = 0.1F}, {0.6F, 0.0F, true}, kBounds, 0.02F).v < 0.11F);  // speeding up is none of its business
}

TEST_CASE("a turn to neither side keeps the last one") {
  CHECK(turned_side(0.2F, -1.0F) == 1.0F);
  CHECK(turned_side(-0.2F, 1.0F) == -1.0F);
  CHECK(turned_side(0.05F, -1.0F) == -1.0F);
}

TEST_CASE("a quarter circle of 0.5 m radius ends where it should") {
  RobotState s{0.0F, 0.0F, 0.0F, 0.5F, 1.0F, 0.0F};
  for (int k = 0; k < 157; ++k) s = moved(s, {0.5F, 1.0F}, kBounds, 0.01F);
  CHECK(s.x == Approx(0.5).margin(0.002));
  CHECK(s.y == Approx(0.5).margin(0.002));
  CHECK(s.heading == Approx(1.57).margin(0.001));
}
