#include "planner/tracking/imm_filter.h"

#include <algorithm>

#include "hal/types/trig.h"
#include "planner/cell/kalman.h"

namespace jaywalk {
namespace {
constexpr double kLeastVariance = 1e-8;  // of a speed, m^2/s^2: what rounding leaves is none

/// How a mode moves on: white acceleration of `accel` m^2/s^3 an axis (what speed's variance gains a second), given
/// up for another mode after `sojourn_s` on average, and then for the others by their shares of `next`.
struct ModeParameters {
  double accel = 0.0, sojourn_s = 0.0;
  std::array<double, ImmFilter::kCount> next{};
};

constexpr std::array<ModeParameters, ImmFilter::kCount> kModeParameters{{
    {.accel = 0.0, .sojourn_s = 2.0, .next = {0.0, 0.3, 0.7}},
    {.accel = 0.01, .sojourn_s = 3.0, .next = {0.3, 0.0, 0.7}},
    {.accel = 0.25, .sojourn_s = 0.5, .next = {0.4, 0.6, 0.0}},
}};
constexpr std::array<double, ImmFilter::kCount> kAtFirst{0.4, 0.3, 0.3};

constexpr double kShuffle = 0.0004;  // m^2/s: 2 cm a second that a standing pedestrian shifts
constexpr double kStandsMps = 0.02;  // that may be left of its speed
constexpr double kMostUnlikely = -50.0, kLeastWeight = 1e-6;

/// The states' mean by their weights, with what they differ by in its covariance: half of it an axis.
ModeState mean_of(const std::array<ModeState, ImmFilter::kCount>& states,
                  const std::array<double, ImmFilter::kCount>& weights) {
  ModeState mean;
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

void stand_on(ModeState& s, double dt) {
  s.velocity = {};
  s.covariance = {.pp = s.covariance.pp + kShuffle * dt, .pv = 0.0, .vv = kStandsMps * kStandsMps};
}

/// On by `dt`, or back below 0, which undoes it where there is no acceleration.
void walk_on(ModeState& s, double dt, double accel = 0.0) {
  AxisCovariance& p = s.covariance;
  s.position = s.position + s.velocity * dt;
  const cell::CovarianceGrowth<double> growth = cell::covariance_growth(p.pv, p.vv, dt);
  p.pp += growth.pp + accel * dt * dt * dt / 3.0;
  p.pv += growth.pv + accel * dt * dt / 2.0;
  p.vv += accel * dt;
}

/// Minus the logarithm of how likely a measured position is, but for a constant: two axes.
double negative_log_likelihood(const ModeState& s, Vec2 measured, double noise_m2) {
  const double variance = s.covariance.pp + noise_m2;
  const Vec2 innovation = measured - s.position;
  return 0.5 * dot(innovation, innovation) / variance + log(variance);
}

}  // namespace

void predict(Track& track, double dt, double accel_std) noexcept {
  const double q = accel_std * accel_std;
  AxisCovariance& p = track.covariance;
  track.position_in_map = track.position_in_map + track.velocity_in_map * dt;
  const cell::CovarianceGrowth<double> growth = cell::covariance_growth(p.pv, p.vv, dt);
  p.pp += growth.pp + q * dt * dt * dt * dt / 4.0;
  p.pv += growth.pv + q * dt * dt * dt / 2.0;
  p.vv += q * dt * dt;
}

void correct(Vec2& position, Vec2& velocity, AxisCovariance& p, Vec2 measured, double noise_m2) noexcept {
  const double variance = p.pp + noise_m2, gain_velocity = p.pv / variance;
  const Vec2 innovation = measured - position;
  position = position + innovation * (p.pp / variance);
  velocity = velocity + innovation * gain_velocity;
  p.vv = std::max(p.vv - gain_velocity * p.pv, kLeastVariance);
  p.pv *= noise_m2 / variance;  // 1 less the gain, which may be too near 1 to subtract
  p.pp *= noise_m2 / variance;
}

double gate_distance2(const Track& track, Vec2 measured, double std_m, double late_s) noexcept {
  const AxisCovariance& p = track.covariance;
  const Vec2 innovation = measured - (track.position_in_map + track.velocity_in_map * late_s);
  return dot(innovation, innovation) / (p.pp + cell::covariance_growth(p.pv, p.vv, late_s).pp + std_m * std_m);
}

ImmFilter::ImmFilter(const Track& track) {
  for (std::size_t k = 0; k < kCount; ++k) {
    modes_[k] = {track.position_in_map, track.velocity_in_map, track.covariance, kAtFirst[k]};
  }
}

void ImmFilter::mix(double dt) noexcept {
  const std::array<ModeState, kCount> before = modes_;
  for (std::size_t to = 0; to < kCount; ++to) {
    std::array<double, kCount> share{};
    double sum = 0.0;
    for (std::size_t from = 0; from < kCount; ++from) {
      const double leaves = dt / (dt + kModeParameters[from].sojourn_s);
      share[from] = before[from].weight * (from == to ? 1.0 - leaves : leaves * kModeParameters[from].next[to]);
      sum += share[from];
    }
    for (double& s : share) s /= sum;
    modes_[to] = mean_of(before, share);
    modes_[to].weight = sum;
  }
}

void ImmFilter::predict(Track& track, double dt) noexcept {
  if (dt > 0.0) {
    mix(dt);
    stand_on(modes_[kStands], dt);
    walk_on(modes_[kWalks], dt, kModeParameters[kWalks].accel);
    walk_on(modes_[kTurns], dt, kModeParameters[kTurns].accel);
  }
  report(track);
}

void ImmFilter::correct(Track& track, Vec2 measured, double std_m, double late_s) noexcept {
  std::array<double, kCount> unlikely{};
  for (std::size_t k = 0; k < kCount; ++k) {
    ModeState& s = modes_[k];
    walk_on(s, late_s);  // straight: nobody turns within part of a sweep
    unlikely[k] = negative_log_likelihood(s, measured, std_m * std_m);
    jaywalk::correct(s.position, s.velocity, s.covariance, measured, std_m * std_m);
    walk_on(s, -late_s);
  }
  const double least = *std::min_element(unlikely.begin(), unlikely.end());
  double sum = 0.0;
  for (std::size_t k = 0; k < kCount; ++k) {
    modes_[k].weight = std::max(modes_[k].weight * exp(std::max(least - unlikely[k], kMostUnlikely)), kLeastWeight);
    sum += modes_[k].weight;
  }
  for (ModeState& s : modes_) s.weight /= sum;
  report(track);
}

void ImmFilter::date_back(Track& track, double late_s) noexcept {
  for (ModeState& s : modes_) walk_on(s, -late_s);
  report(track);
}

void ImmFilter::report(Track& track) const noexcept {
  std::array<double, kCount> weights{};
  for (std::size_t k = 0; k < kCount; ++k) weights[k] = modes_[k].weight;
  const ModeState mean = mean_of(modes_, weights);
  track.position_in_map = mean.position;
  track.velocity_in_map = mean.velocity;
  track.covariance = mean.covariance;
}

}  // namespace jaywalk
