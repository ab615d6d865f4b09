#pragma once
#include "planner/tracking/bodies.h"
#include "planner/tracking/observation.h"

namespace jaywalk {

/// `body`, predicted to `now`, was seen: corrects its track and what is known of it besides.
void take_sight(Body& body, const Observation& seen, const Pose2& map_from_laser, Time now) noexcept;

/// What is kept of how a body was seen last, and nothing else.
void note_sight(Body& body, const Observation& seen) noexcept;

}  // namespace jaywalk
