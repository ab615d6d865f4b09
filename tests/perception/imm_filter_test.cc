#include "planner/tracking/imm_filter.h"

#include <cmath>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

Track newcomer() {
  Track track;
  track.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 1.0};
  return track;
}

constexpr double kScanS = 1.0 / 15.0, kStdM = 0.01;

/// Centimetre noise that adds up to nothing.
Vec2 noise(int k) { return Vec2{k % 2 == 0 ? 0.007 : -0.007, k % 4 < 2 ? 0.007 : -0.007}; }

/// Sees the body at `place` a scan later.
void see(ImmFilter& models, Track& track, Vec2 place) {
  models.predict(track, kScanS);
  models.correct(track, place, kStdM);
}

}  // namespace

TEST_CASE("who stands is known to stand and has next to no speed") {
  Track track = newcomer();
  ImmFilter models(track);
  for (int k = 0; k < 30; ++k) see(models, track, noise(k));
  CHECK(models.weight(ImmFilter::kStands) > 0.7);
  CHECK(norm(track.velocity_in_map) < 0.03);
  CHECK(norm(track.position_in_map) < 0.01);
}

TEST_CASE("who walks straight on is known to walk within half a second and its speed to a few centimetres") {
  Track track = newcomer();
  ImmFilter models(track);
  for (int k = 0; k < 8; ++k) see(models, track, Vec2{0.4 * kScanS * k, 0.0} + noise(k));
  CHECK(models.weight(ImmFilter::kStands) < 0.05);
  for (int k = 8; k < 30; ++k) see(models, track, Vec2{0.4 * kScanS * k, 0.0} + noise(k));
  CHECK(models.weight(ImmFilter::kWalks) > 0.6);
  CHECK(distance(track.velocity_in_map, {0.4, 0.0}) < 0.05);
  CHECK(track.covariance.vv < 0.01);  // 0.1 m/s
}

TEST_CASE("who turns at right angles is followed within half a second and doubted meanwhile") {
  Track track = newcomer();
  ImmFilter models(track);
  for (int k = 0; k < 30; ++k) see(models, track, Vec2{0.8 * kScanS * k, 0.0} + noise(k));
  const double sure = track.covariance.vv;
  const Vec2 corner{0.8 * kScanS * 29, 0.0};
  double doubt = 0.0;
  for (int k = 1; k <= 8; ++k) {
    see(models, track, corner + Vec2{0.0, 0.8 * kScanS * k} + noise(k));
    doubt = std::fmax(doubt, track.covariance.vv);
  }
  CHECK(doubt > 3.0 * sure);
  CHECK(distance(track.velocity_in_map, {0.0, 0.8}) < 0.2);
}

TEST_CASE("weights are shares and stay so however wrong every model was") {
  Track track = newcomer();
  ImmFilter models(track);
  for (int k = 0; k < 10; ++k) see(models, track, {k % 2 == 0 ? 50.0 : -50.0, 0.0});
  double sum = 0.0;
  for (const auto model : {ImmFilter::kStands, ImmFilter::kWalks, ImmFilter::kTurns}) {
    CHECK(models.weight(model) > 0.0);
    sum += models.weight(model);
  }
  CHECK(sum == Approx(1.0).margin(1e-5));
  CHECK(std::isfinite(track.position_in_map.x));
}

TEST_CASE("a second unseen makes a walker a good deal more doubtful and takes it on") {
  Track track = newcomer();
  ImmFilter models(track);
  for (int k = 0; k < 30; ++k) see(models, track, Vec2{0.8 * kScanS * k, 0.0} + noise(k));
  const Track seen = track;
  for (int k = 0; k < 15; ++k) models.predict(track, kScanS);
  CHECK(track.position_in_map.x > seen.position_in_map.x + 0.5);
  CHECK(track.position_in_map.x < seen.position_in_map.x + 0.85);
  CHECK(track.covariance.pp > 10.0 * seen.covariance.pp);
  CHECK(track.covariance.pp * track.covariance.vv > track.covariance.pv * track.covariance.pv);
}

TEST_CASE("who is met where he should be by then, late in a sweep, is where he should be at its beginning") {
  Track track;
  track.velocity_in_map = {1.2, 0.0};
  track.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 0.01};
  ImmFilter models(track);
  models.correct(track, {0.12, 0.0}, kStdM, 0.1);
  CHECK(distance(track.position_in_map, {0.0, 0.0}) < 1e-9);
  CHECK(distance(track.velocity_in_map, {1.2, 0.0}) < 1e-9);
  models.date_back(track, 0.1);
  CHECK(distance(track.position_in_map, {-0.12, 0.0}) < 1e-9);
}

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

TEST_CASE("the gate counts squared standard deviations of the innovation when a beam met the track") {
  Track track;
  track.covariance.pp = 0.03;
  // (0.3^2 + 0.4^2) / (0.03 + 0.1^2) = 0.25 / 0.04.
  CHECK(gate_distance2(track, {0.3, 0.4}, 0.1) == Approx(6.25));
  track.velocity_in_map = {1.0, 0.0};
  track.covariance = {.pp = 0.01, .pv = 0.01, .vv = 0.04};
  // Half a second on: at (0.5, 0), of variance 0.01 + 2 x 0.5 x 0.01 + 0.5^2 x 0.04 = 0.03; 0.25 / (0.03 + 0.1^2).
  CHECK(gate_distance2(track, {0.8, 0.4}, 0.1, 0.5) == Approx(6.25));
}
