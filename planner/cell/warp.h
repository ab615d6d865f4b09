#pragma once
#include <cmath>

#include "planner/cell/cell.h"

namespace jaywalk::cell {

/// The warp number of a place `ahead` of the robot and `left` of it, as the length r of the major
/// axis of the ellipse that it lies on (equation time-warp, solved for r): with r_x = 4 r_y and the
/// centre 0.9 r ahead, 0.19 r^2 + 1.8 a r - (a^2 + 16 l^2) = 0. Same unit as the offsets.
/// Straight ahead a/1.9, straight behind 10 |a|, abeam 9.18 |l|.
JAYWALK_CELL float warp_radius(float ahead, float left) {
  return (std::sqrt(ahead * ahead + 3.04F * (left * left)) - 0.9F * ahead) / 0.19F;
}

/// The warp of mode full: orbits are circles, r is how far the robot travels before it can be there.
/// (The ellipses put a party abeam at 9 times its distance: 31 s for one 2 m away at 0.6 m/s.)
JAYWALK_CELL float arrival_radius(float ahead, float left) { return std::sqrt(ahead * ahead + left * left); }

/// Time (s) until a party of this speed has covered the warp radius, never beyond `cap_s`.
JAYWALK_CELL float horizon(float radius, float speed, float cap_s) {
  return radius >= speed * cap_s ? cap_s : radius / speed;
}

}  // namespace jaywalk::cell
