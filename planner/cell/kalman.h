#pragma once
#include "planner/cell/cell.h"

namespace jaywalk::cell {

/// Position and velocity along one axis with their covariance (constant velocity, white noise
/// acceleration). Any one unit of length; seconds.
struct AxisState {
  float position, velocity;
  float pp, pv, vv;
};

/// Time update over `dt` seconds (equations kalman_time1 and kalman_time2 with the paper's A):
/// x' = A x, P' = A P A^T + Q, Q = q [dt^3/3, dt^2/2; dt^2/2, dt], q in length^2/s^3.
JAYWALK_CELL AxisState predict(const AxisState& s, float dt, float q) {
  AxisState out;
  out.position = s.position + dt * s.velocity;
  out.velocity = s.velocity;
  out.pp = s.pp + dt * (2.0F * s.pv + dt * s.vv) + q * (dt * dt * dt) / 3.0F;
  out.pv = s.pv + dt * s.vv + q * (dt * dt) / 2.0F;
  out.vv = s.vv + q * dt;
  return out;
}

}  // namespace jaywalk::cell
