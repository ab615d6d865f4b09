#pragma once
// The harmonic potential in complement and logarithm: u = 1 - phi, psi = -ln u. phi = 0 at the goal
// and 1 in obstacles becomes psi = 0 and infinity, and a falling phi a falling psi. A solution is
// kept as u = exp(-psi) v with v near 1, so that single precision resolves what phi cannot: in a
// corridor w cells wide u falls by exp(-k) a cell (docs/algorithm.md).
#include "planner/cell/cell.h"
#include "planner/cell/exp_log.h"

namespace jaywalk::cell {

/// What a cell takes of each neighbour.
struct alignas(16) Couplings {
  float east, west, north, south;
};

JAYWALK_CELL float sum(const Couplings& a) { return (a.east + a.west) + (a.north + a.south); }

/// Equation discrete-laplace, rebased: u_c = (sum of u_n)/4 with u = exp(-psi) v gives v_c = sum of
/// a_n v_n with a_n = exp(psi_c - psi_n)/4. A neighbour that is not free has u = 0 and a_n = 0.
JAYWALK_CELL float coupling(float psi_here, float psi_neighbour) {
  return is_joined(psi_neighbour) ? 0.25F * exp(psi_here - psi_neighbour) : 0.0F;
}

/// The weighted mean that every level of the solver relaxes to: x_c = sum of a_n x_n + source.
JAYWALK_CELL float relaxed(const Couplings& a, float east, float west, float north, float south, float source) {
  return ((a.east * east + a.west * west) + (a.north * north + a.south * south)) + source;
}

/// v after a coarse correction: never below half of what it was, since u stays positive (with a
/// floor of 0.1 descent is lost at 512 cells a side).
JAYWALK_CELL float corrected(float v, float correction) {
  const float floor = 0.5F * v;
  const float moved = v + correction;
  return moved > floor ? moved : floor;
}

/// psi with v absorbed: -ln(exp(-psi) v).
JAYWALK_CELL float rebased(float psi, float v) { return psi - log(v); }

}  // namespace jaywalk::cell
