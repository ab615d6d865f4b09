#pragma once
// Angles in single precision from IEEE operations alone: the same bits on every processor.

#include "planner/cell/cell.h"

namespace jaywalk::cell {

inline constexpr float kPiF = 3.14159265F;

/// A direction as a unit vector.
struct Heading {
  float x = 1.0F, y = 0.0F;
};

/// The direction at `rad` radians from +x; error below 8e-6 for |rad| up to 100.
JAYWALK_CELL Heading heading_at(float rad) {
  // rad = q pi/2 + r with |r| <= pi/4; pi/2 in two parts, the first exact in 12 bits. r^9/9! < 4e-7, r^8/8! < 4e-6.
  const float quarters = rad * 0.636619772F;
  const auto q = static_cast<std::int32_t>(quarters < 0.0F ? quarters - 0.5F : quarters + 0.5F);
  const auto qf = static_cast<float>(q);
  const float r = (rad - qf * 1.57080078F) + qf * 4.45445511e-6F;
  const float r2 = r * r;
  const float s = r * (1.0F + r2 * (-1.0F / 6.0F + r2 * (1.0F / 120.0F + r2 * (-1.0F / 5040.0F))));
  const float c = 1.0F + r2 * (-0.5F + r2 * (1.0F / 24.0F + r2 * (-1.0F / 720.0F + r2 * (1.0F / 40320.0F))));
  const bool swapped = (q & 1) != 0, negative_x = ((q + 1) & 2) != 0, negative_y = (q & 2) != 0;
  const float x = swapped ? s : c, y = swapped ? c : s;
  return {negative_x ? -x : x, negative_y ? -y : y};
}

/// The angle of (x, y) in [-pi, pi], 0 at the origin; error below 3e-5 rad.
JAYWALK_CELL float angle_of(float x, float y) {
  const float ax = x < 0.0F ? -x : x, ay = y < 0.0F ? -y : y;
  const float larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
  if (larger <= 0.0F) return 0.0F;
  // atan on [0, 1]; coefficients: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49.
  const float z = smaller / larger, z2 = z * z;
  const float in_octant =
      z * (0.9998660F + z2 * (-0.3302995F + z2 * (0.1801410F + z2 * (-0.0851330F + z2 * 0.0208351F))));
  const float in_quadrant = ay > ax ? 0.5F * kPiF - in_octant : in_octant;
  const float in_half = x < 0.0F ? kPiF - in_quadrant : in_quadrant;
  return y < 0.0F ? -in_half : in_half;
}

/// The same angle in [-pi, pi]; |rad| up to 1000.
JAYWALK_CELL float wrapped(float rad) {
  const float turns = rad * 0.159154943F;
  const auto whole = static_cast<float>(static_cast<std::int32_t>(turns < 0.0F ? turns - 0.5F : turns + 0.5F));
  return rad - whole * 6.28318531F;
}

}  // namespace jaywalk::cell
