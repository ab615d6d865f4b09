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
