#pragma once
#include "planner/tracking/bodies.h"
#include "planner/tracking/surroundings.h"

namespace jaywalk {

/// Decides, once a scan, whether a body moves beyond reasonable doubt (Track::moving), whether it stands for good
/// (Body::settled) and whether it may be somebody (Body::somebody). Two thresholds keep it from wavering: it must set
/// out (departure.h) in two scans running, or certainly in one, to be called moving, and stays so until it has been
/// slow for more than four seconds.
void judge_motion(Body& body, const Surroundings& around, Time now) noexcept;

}  // namespace jaywalk
