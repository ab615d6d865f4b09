#pragma once
// The harmonic potential in complement and logarithm: u = 1 - phi, psi = -ln u. phi = 0 at the goal
// and 1 in obstacles becomes psi = 0 and infinity, and a falling phi a falling psi. A solution is
// kept as u = exp(-psi) v with v near 1, so that single precision resolves what phi cannot: in a
// corridor w cells wide u falls by exp(-k) a cell (docs/explanation/algorithm.md).
#include "planner/cell/cell.h"
#include "planner/cell/exp_log.h"

namespace jaywalk::cell {

/// What a cell takes of each neighbour.
struct Couplings {
  float east, west, north, south;
};

JAYWALK_CELL float sum(const Couplings& a) { return (a.east + a.west) + (a.north + a.south); }

/// Equation discrete-laplace, rebased: u_c = (sum of u_n)/4 with u = exp(-psi) v gives v_c = sum of
/// a_n v_n with a_n = exp(psi_c - psi_n)/4. What is not free has u = 0, takes nothing and gives nothing.
/// (Selects instead of branches here and below: they let four cells go at once.)
JAYWALK_CELL float coupling(float psi_here, float psi_neighbour, bool neighbour_exists) {
  float fall = is_joined(psi_here) ? psi_here - psi_neighbour : 0.0F;
  fall = is_joined(psi_neighbour) ? fall : 0.0F;
  float a = is_joined(psi_here) ? 0.25F * exp(fall) : 0.0F;
  a = is_joined(psi_neighbour) ? a : 0.0F;
  return neighbour_exists ? a : 0.0F;
}

/// What the neighbour takes of this cell, given what this cell takes of it: exp(d)/4 one way is exp(-d)/4 the other.
JAYWALK_CELL float coupling_back(float coupling_there) {
  const float a = 0.0625F / (coupling_there > 0.0F ? coupling_there : 1.0F);
  return coupling_there > 0.0F ? a : 0.0F;
}

/// Weight of a cell's equation in its block's, exp(-2 (psi - base)) times what it was divided by; 0 where it
/// has no equation.
JAYWALK_CELL float block_weight(bool has_equation, float diagonal, float psi, float base) {
  const float rise = has_equation ? psi - base : 0.0F;
  const float weight = diagonal * exp(-2.0F * rise);
  return has_equation ? weight : 0.0F;
}

/// The weighted mean that every level of the solver relaxes to: x_c = sum of a_n x_n + source.
JAYWALK_CELL float relaxed(const Couplings& a, float east, float west, float north, float south, float source) {
  return ((a.east * east + a.west * west) + (a.north * north + a.south * south)) + source;
}

/// v after a coarse correction: never below an eighth of what it was, since u stays positive. (Half would hold back a
/// level that is too high by a factor of two a cycle; less than a tenth leaves pits where a correction was too strong.)
JAYWALK_CELL float corrected(float v, float correction) {
  const float floor = 0.125F * v;
  const float moved = v + (v > 0.0F ? correction : 0.0F);
  return moved > floor ? moved : floor;
}

/// psi with v absorbed: -ln(exp(-psi) v); v = 0 is where there is no equation, and psi stays as it is. (A NaN less 0
/// would be another NaN on a GPU.)
JAYWALK_CELL float rebased(float psi, float v) {
  const float factor = v > 0.0F ? v : 1.0F;
  const float absorbed = psi - log(factor);
  return v > 0.0F ? absorbed : psi;
}

}  // namespace jaywalk::cell
