#include "planner/perception/kalman.h"

#include "planner/cell/kalman.h"

namespace jaywalk {

void predict(Track& track, double dt, double accel_std) noexcept {
  const double q = accel_std * accel_std;
  AxisCovariance& p = track.covariance;
  track.position_in_map = track.position_in_map + track.velocity_in_map * dt;
  const cell::CovarianceGrowth<double> growth = cell::covariance_growth(p.pv, p.vv, dt);
  p.pp += growth.pp + q * dt * dt * dt * dt / 4.0;
  p.pv += growth.pv + q * dt * dt * dt / 2.0;
  p.vv += q * dt * dt;
}

void correct(Track& track, Vec2 measured, double std_m) noexcept {
  AxisCovariance& p = track.covariance;
  const double innovation_variance = p.pp + std_m * std_m;
  const double gain_position = p.pp / innovation_variance;
  const double gain_velocity = p.pv / innovation_variance;
  const Vec2 innovation = measured - track.position_in_map;
  track.position_in_map = track.position_in_map + innovation * gain_position;
  track.velocity_in_map = track.velocity_in_map + innovation * gain_velocity;
  p.vv -= gain_velocity * p.pv;
  p.pv -= gain_position * p.pv;
  p.pp -= gain_position * p.pp;
}

double gate_distance2(const Track& track, Vec2 measured, double std_m) noexcept {
  const Vec2 innovation = measured - track.position_in_map;
  return dot(innovation, innovation) / (track.covariance.pp + std_m * std_m);
}

}  // namespace jaywalk
