#pragma once
// A target from one scan to the next: predicted, then corrected by what the scan shows of it.
#include "planner/tracking/observation.h"
#include "planner/tracking/target.h"

namespace jaywalk {

/// From one scan or report to the next, s: 0 where there was none before or time went back, and 1 at most, since those
/// farther apart tell no velocity.
[[nodiscard]] double step_seconds(Time from, Time to) noexcept;

/// Moves a target on to where it should be at `stamp`, by its filter or, where it is `given` from outside, as the
/// paper's movers go on. A stamp before its own changes nothing.
void predict_to(Estimate& estimate, bool given, Time stamp) noexcept;

/// `target`, predicted to `now`, was seen: corrects its track and what is known of it besides.
void update_with(Target& target, const Observation& seen, const Pose2& map_from_laser, Time now) noexcept;

/// What is kept of how a target was seen last, and nothing else.
void note_seen(Estimate& estimate, Appearance& appearance, const Observation& seen) noexcept;

}  // namespace jaywalk
