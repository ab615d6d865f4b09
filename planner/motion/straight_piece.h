#pragma once
#include "planner/motion/body_map.h"
#include "planner/motion/manoeuvre.h"

namespace jaywalk {

/// Draws poses straight ahead of `from` into `piece`, or behind it where `length_m` is negative, as far as the outline
/// keeps `margin_m` from what stands, or from what is nearer at the start comes no nearer. Fewer than two poses: no
/// way.
void draw_straight(const BodyMap& map, const Pose2& from, double length_m, double margin_m, Manoeuvre& piece) noexcept;

}  // namespace jaywalk
