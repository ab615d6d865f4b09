#include "planner/tracking/imm_filter.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("prediction moves by velocity times time and the covariance grows as A P AT plus Q") {
  Track track;
  track.position_in_map = {1.0, 2.0};
  track.velocity_in_map = {0.5, -1.0};
  track.covariance = {.pp = 0.04, .pv = 0.01, .vv = 0.09};
  predict(track, 2.0, 0.5);
  CHECK(track.position_in_map.x == Approx(2.0));
  CHECK(track.position_in_map.y == Approx(0.0));
  // pp = 0.04 + 2 (2 x 0.01 + 2 x 0.09) + 0.25 x 16 / 4 = 0.04 + 0.40 + 1.0; pv = 0.01 + 0.18 + 0.25 x 8 / 2;
  // vv = 0.09 + 0.25 x 4.
  CHECK(track.covariance.pp == Approx(1.44));
  CHECK(track.covariance.pv == Approx(1.19));
  CHECK(track.covariance.vv == Approx(1.09));
}

TEST_CASE("correction weighs prediction and measurement by their variances") {
  Vec2 position{1.0, 0.0}, velocity{0.0, 0.0};
  AxisCovariance covariance{.pp = 0.03, .pv = 0.02, .vv = 0.5};
  correct(position, velocity, covariance, {1.4, 0.0}, 0.01);
  // S = 0.03 + 0.01 = 0.04; gains 0.75 and 0.5; innovation 0.4: position 1.3, velocity 0.2;
  // pp = 0.25 x 0.03, pv = 0.25 x 0.02, vv = 0.5 - 0.5 x 0.02.
  CHECK(position.x == Approx(1.3));
  CHECK(velocity.x == Approx(0.2));
  CHECK(covariance.pp == Approx(0.0075));
  CHECK(covariance.pv == Approx(0.005));
  CHECK(covariance.vv == Approx(0.49));
}

TEST_CASE("a measurement far surer than what was believed leaves no variance at or below nothing") {
  Vec2 position, velocity;
  AxisCovariance covariance{.pp = 1e6, .pv = 1e6, .vv = 1e6};  // place and speed are one and the same doubt
  correct(position, velocity, covariance, {1.0, 0.0}, 1e-12);
  CHECK(covariance.pp > 0.0);
  CHECK(covariance.pv > 0.0);
  CHECK(covariance.vv > 0.0);
}

TEST_CASE("the gate counts squared standard deviations of the innovation") {
  Track track;
  track.covariance.pp = 0.03;
  // (0.3^2 + 0.4^2) / (0.03 + 0.1^2) = 0.25 / 0.04.
  CHECK(gate_distance2(track, {0.3, 0.4}, 0.1) == Approx(6.25));
}

TEST_CASE("the gate goes with a track to when a beam met it") {
  Track track;
  track.velocity_in_map = {1.0, 0.0};
  track.covariance = {.pp = 0.01, .pv = 0.01, .vv = 0.04};
  // Half a second on: at (0.5, 0), of variance 0.01 + 2 x 0.5 x 0.01 + 0.5^2 x 0.04 = 0.03; 0.25 / (0.03 + 0.1^2).
  CHECK(gate_distance2(track, {0.8, 0.4}, 0.1, 0.5) == Approx(6.25));
}
