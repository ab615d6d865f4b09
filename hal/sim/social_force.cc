#include "hal/sim/social_force.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::sim::social {
namespace {

// Section III of the paper.
constexpr double kWalkerPotential_m2ps2 = 2.1, kWalkerRange_m = 0.3;  // V0, sigma
constexpr double kWallPotential_m2ps2 = 10.0, kWallRange_m = 0.2;     // U0, R
constexpr double kStep_s = 2.0;                                       // Delta t: how far ahead others are expected
constexpr double kFar_m = 3.0;                                        // b beyond which a force is below 0.0005 m/s2
constexpr double kUnseen = 0.5;                                       // c
constexpr double kLeast_m = 0.01;                                     // outlines are never taken for nearer

}  // namespace

Vec2 towards(Vec2 wished_mps, Vec2 velocity_mps) noexcept {
  return (wished_mps - velocity_mps) * (1.0 / kRelaxation_s);
}

/// b is the semi-minor axis of the ellipse through `apart_m` with foci at the other pedestrian now and Delta t later;
/// the force is -grad V0 exp(-b / sigma).
Vec2 away_from_walker(Vec2 apart_m, Vec2 velocity_mps) noexcept {
  const Vec2 step = velocity_mps * kStep_s, from_next = apart_m - step;
  const double now = norm(apart_m), next = std::max(norm(from_next), kLeast_m), sum = now + next;
  const double b = std::max(0.5 * std::sqrt(std::max(sum * sum - dot(step, step), 0.0)), kLeast_m);
  if (b > kFar_m) return {};
  const Vec2 gradient_of_b = (apart_m * (1.0 / now) + from_next * (1.0 / next)) * (sum / (4.0 * b));
  return gradient_of_b * (kWalkerPotential_m2ps2 / kWalkerRange_m * exp(-b / kWalkerRange_m));
}

Vec2 away_from_wall(Vec2 apart_m) noexcept {
  const double gap = norm(apart_m);
  return apart_m * (kWallPotential_m2ps2 / kWallRange_m * exp(-gap / kWallRange_m) / gap);
}

bool in_sight(Vec2 ahead, Vec2 to) noexcept { return dot(ahead, to) >= norm(to) * cos(kHalfSight_rad); }

Vec2 as_seen(Vec2 force, Vec2 ahead) noexcept { return in_sight(ahead, force * -1.0) ? force : force * kUnseen; }

Vec2 between_outlines(Vec2 apart_m, double radii_m) noexcept {
  const double centres = norm(apart_m);
  if (centres < kLeast_m) return {kLeast_m, 0.0};
  return apart_m * (std::max(centres - radii_m, kLeast_m) / centres);
}

}  // namespace jaywalk::sim::social
