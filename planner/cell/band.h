#pragma once
#include <cmath>

#include "planner/cell/cell.h"

namespace jaywalk::cell {

struct Point {
  float x, y;
};

/// Tension of the two neighbours on a point of the band (T_{i-1} + T_{i+1}, halved): towards their middle.
JAYWALK_CELL Point tension(Point before, Point here, Point after) {
  return {0.5F * (before.x + after.x) - here.x, 0.5F * (before.y + after.y) - here.y};
}

/// Force of the clearance potential (1 - D/reach)^2 reach/4 below `reach` cells of clearance D, zero
/// above: sideways, away from what is near. `slope` is the gradient of D.
///
/// The paper's F is a difference of 1/(1 - phi) = e^psi (equation force): with a converged field it
/// grows by e^k a cell and swamps the tension. ln of it, psi, falls steadily along the way and
/// drags points along the band; the clearance acts across it, which is what is wanted.
JAYWALK_CELL Point clearance_force(float clearance, Point slope, float reach) {
  if (clearance >= reach) return {0.0F, 0.0F};
  const float strength = 0.5F * (1.0F - clearance / reach);
  return {strength * slope.x, strength * slope.y};
}

/// Cosine of the sharpest turn that a move may make at a point of the band: 45 degrees.
inline constexpr float kSharpest = 0.70710678F;

/// Cosine of the turn at `here`; NaN where two of the points coincide.
JAYWALK_CELL float turn_cosine(Point before, Point here, Point after) {
  const float ax = here.x - before.x, ay = here.y - before.y, bx = after.x - here.x, by = after.y - here.y;
  return (ax * bx + ay * by) / std::sqrt((ax * ax + ay * ay) * (bx * bx + by * by));
}

/// The point moved by its resultant force (equations resultant and drag). A `give` of 1 would take a
/// straight band to rest in one step; below 1 it does not swing.
JAYWALK_CELL Point dragged(Point here, Point pull, Point force, float give) {
  return {here.x + give * (pull.x + force.x), here.y + give * (pull.y + force.y)};
}

}  // namespace jaywalk::cell
