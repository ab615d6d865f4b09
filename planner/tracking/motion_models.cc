#include "planner/tracking/motion_models.h"

#include <algorithm>

#include "hal/types/trig.h"
#include "planner/cell/kalman.h"
#include "planner/tracking/kalman.h"

namespace jaywalk {
namespace {

/// How a model moves on: white acceleration of `accel` m^2/s^3 an axis (what speed's variance gains a second), given
/// up for another model after `stays_s` on average, and then for the others by their shares of `next`.
struct Habits {
  double accel = 0.0, stays_s = 0.0;
  std::array<double, MotionModels::kCount> next{};
};

constexpr std::array<Habits, MotionModels::kCount> kHabits{{
    {.accel = 0.0, .stays_s = 2.0, .next = {0.0, 0.3, 0.7}},
    {.accel = 0.01, .stays_s = 3.0, .next = {0.3, 0.0, 0.7}},
    {.accel = 0.25, .stays_s = 0.5, .next = {0.4, 0.6, 0.0}},
}};
constexpr std::array<double, MotionModels::kCount> kAtFirst{0.4, 0.3, 0.3};

constexpr double kShuffle = 0.0004;  // m^2/s: 2 cm a second that one who stands shifts
constexpr double kStandsMps = 0.02;  // that may be left of its speed
constexpr double kMostUnlikely = -50.0, kLeastWeight = 1e-6;

/// The states' mean by their weights, with what they differ by in its covariance: half of it an axis.
ModelState mean_of(const std::array<ModelState, MotionModels::kCount>& states,
                   const std::array<double, MotionModels::kCount>& weights) {
  ModelState mean;
  for (std::size_t k = 0; k < states.size(); ++k) {
    mean.position = mean.position + states[k].position * weights[k];
    mean.velocity = mean.velocity + states[k].velocity * weights[k];
  }
  for (std::size_t k = 0; k < states.size(); ++k) {
    const Vec2 p = states[k].position - mean.position, v = states[k].velocity - mean.velocity;
    const AxisCovariance& c = states[k].covariance;
    mean.covariance.pp += weights[k] * (c.pp + 0.5 * dot(p, p));
    mean.covariance.pv += weights[k] * (c.pv + 0.5 * dot(p, v));
    mean.covariance.vv += weights[k] * (c.vv + 0.5 * dot(v, v));
  }
  return mean;
}

void stand_on(ModelState& s, double dt) {
  s.velocity = {};
  s.covariance = {.pp = s.covariance.pp + kShuffle * dt, .pv = 0.0, .vv = kStandsMps * kStandsMps};
}

void walk_on(ModelState& s, double dt, double accel) {
  AxisCovariance& p = s.covariance;
  s.position = s.position + s.velocity * dt;
  const cell::CovarianceGrowth<double> growth = cell::covariance_growth(p.pv, p.vv, dt);
  p.pp += growth.pp + accel * dt * dt * dt / 3.0;
  p.pv += growth.pv + accel * dt * dt / 2.0;
  p.vv += accel * dt;
}

/// On by part of a sweep, or back below 0, which undoes it: nobody turns within it.
void glide(ModelState& s, double dt) { walk_on(s, dt, 0.0); }

/// Minus the logarithm of how likely a measured position is, but for a constant: two axes.
double unlikeliness(const ModelState& s, Vec2 measured, double noise_m2) {
  const double variance = s.covariance.pp + noise_m2;
  const Vec2 innovation = measured - s.position;
  return 0.5 * dot(innovation, innovation) / variance + log(variance);
}

}  // namespace

MotionModels::MotionModels(const Track& track) {
  for (std::size_t k = 0; k < kCount; ++k) {
    models_[k] = {track.position_in_map, track.velocity_in_map, track.covariance, kAtFirst[k]};
  }
}

void MotionModels::mix(double dt) noexcept {
  const std::array<ModelState, kCount> before = models_;
  for (std::size_t to = 0; to < kCount; ++to) {
    std::array<double, kCount> share{};
    double sum = 0.0;
    for (std::size_t from = 0; from < kCount; ++from) {
      const double leaves = dt / (dt + kHabits[from].stays_s);
      share[from] = before[from].weight * (from == to ? 1.0 - leaves : leaves * kHabits[from].next[to]);
      sum += share[from];
    }
    for (double& s : share) s /= sum;
    models_[to] = mean_of(before, share);
    models_[to].weight = sum;
  }
}

void MotionModels::predict(Track& track, double dt) noexcept {
  if (dt > 0.0) {
    mix(dt);
    stand_on(models_[kStands], dt);
    walk_on(models_[kWalks], dt, kHabits[kWalks].accel);
    walk_on(models_[kTurns], dt, kHabits[kTurns].accel);
  }
  report(track);
}

void MotionModels::correct(Track& track, Vec2 measured, double std_m, double late_s) noexcept {
  std::array<double, kCount> surprise{};
  for (std::size_t k = 0; k < kCount; ++k) {
    ModelState& s = models_[k];
    glide(s, late_s);
    surprise[k] = unlikeliness(s, measured, std_m * std_m);
    jaywalk::correct(s.position, s.velocity, s.covariance, measured, std_m * std_m);
    glide(s, -late_s);
  }
  const double least = *std::min_element(surprise.begin(), surprise.end());
  double sum = 0.0;
  for (std::size_t k = 0; k < kCount; ++k) {
    models_[k].weight = std::max(models_[k].weight * exp(std::max(least - surprise[k], kMostUnlikely)), kLeastWeight);
    sum += models_[k].weight;
  }
  for (ModelState& s : models_) s.weight /= sum;
  report(track);
}

void MotionModels::date_back(Track& track, double late_s) noexcept {
  for (ModelState& s : models_) glide(s, -late_s);
  report(track);
}

void MotionModels::move(Vec2 by_m) noexcept {
  for (ModelState& s : models_) s.position = s.position + by_m;
}

void MotionModels::report(Track& track) const noexcept {
  std::array<double, kCount> weights{};
  for (std::size_t k = 0; k < kCount; ++k) weights[k] = models_[k].weight;
  const ModelState mean = mean_of(models_, weights);
  track.position_in_map = mean.position;
  track.velocity_in_map = mean.velocity;
  track.covariance = mean.covariance;
}

}  // namespace jaywalk
