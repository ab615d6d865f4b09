#pragma once
#include "planner/grid/evidence_map.h"
#include "planner/perception/bodies.h"

namespace jaywalk {

/// Decides, once a scan, whether a body moves beyond reasonable doubt (Track::moving) and whether it stands for good
/// (Body::settled). Two thresholds keep it from wavering: it must have gone somewhere, and fast against its own
/// covariance, to be called moving; it stays so until it has been slow for a second. And the world must agree: either
/// it now stands where nothing stood before, or beams pass through where it stood first. A wall of which a scan sees
/// another part each time does neither. What rides along with the laser belongs to the robot.
void judge_motion(Body& body, const EvidenceMap& still, const Pose2& map_from_laser, Time now) noexcept;

}  // namespace jaywalk
