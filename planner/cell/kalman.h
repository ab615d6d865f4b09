#pragma once
#include "planner/cell/cell.h"

namespace jaywalk::cell {

/// Position and velocity along one axis with their covariance. Any one unit of length; seconds.
struct AxisState {
  float position, velocity;
  float pp, pv, vv;
};

/// What A P A^T adds to the covariance P of (position, velocity) over `dt`, with the paper's A = [1 dt; 0 1].
template <typename Real>
struct CovarianceGrowth {
  Real pp, pv;  ///< nothing is added to vv
};

template <typename Real>
JAYWALK_CELL CovarianceGrowth<Real> covariance_growth(Real pv, Real vv, Real dt) {
  return {dt * (Real(2) * pv + dt * vv), dt * vv};
}

/// Time update over `dt` seconds (equations kalman_time1 and kalman_time2 with the paper's A):
/// x' = A x, P' = A P A^T + Q, Q = q [dt^3/3, dt^2/2; dt^2/2, dt], q in length^2/s^3.
JAYWALK_CELL AxisState predict(const AxisState& s, float dt, float q) {
  const CovarianceGrowth<float> growth = covariance_growth(s.pv, s.vv, dt);
  AxisState out;
  out.position = s.position + dt * s.velocity;
  out.velocity = s.velocity;
  out.pp = s.pp + growth.pp + q * (dt * dt * dt) / 3.0F;
  out.pv = s.pv + growth.pv + q * (dt * dt) / 2.0F;
  out.vv = s.vv + q * dt;
  return out;
}

}  // namespace jaywalk::cell
