#pragma once
#include "planner/perception/bodies.h"

namespace jaywalk {

/// Decides, once a scan, whether a body moves beyond reasonable doubt (Track::moving) and whether it stands for good
/// (Body::settled). Two thresholds keep it from wavering: it must have gone somewhere, and fast against its own
/// covariance, to be called moving; it stays so until it has been slow for a second.
void judge_motion(Body& body, Time now) noexcept;

}  // namespace jaywalk
