#pragma once
#include "planner/tracking/bodies.h"

namespace jaywalk {

/// From one scan or report to the next, s: 0 where there was none before or time went back, and 1 at most, since those
/// farther apart tell no velocity.
[[nodiscard]] double step_seconds(Time from, Time to) noexcept;

/// Moves `body` on to where it should be at `stamp`, by its models or, where it is given from outside, as the paper's
/// movers go on. A stamp before its own changes nothing.
void predict_to(Body& body, Time stamp) noexcept;

}  // namespace jaywalk
