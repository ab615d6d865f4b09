#pragma once
#include "planner/motion/body_map.h"
#include "planner/motion/manoeuvre.h"

namespace jaywalk {

/// A turn on the spot by `turn_rad` (left positive), in pieces of 7.5 degrees, as far as the outline keeps `margin_m`,
/// or where there is less from the start no less, and goes over nothing that was never seen. Empty or one pose: no
/// room.
void draw_turn(const BodyMap& map, const Pose2& from, double turn_rad, double margin_m, Manoeuvre& piece) noexcept;

/// How far it looks round where nothing else is left: a scanner that does not see behind itself sees there then.
inline constexpr double kLookRound_rad = 1.75;

}  // namespace jaywalk
