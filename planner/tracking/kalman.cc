#include "planner/tracking/kalman.h"

#include <algorithm>

#include "planner/cell/kalman.h"

namespace jaywalk {
namespace {

constexpr double kLeastVariance = 1e-8;  // of a speed, m^2/s^2: what rounding leaves is none

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

}  // namespace jaywalk
