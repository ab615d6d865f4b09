#pragma once
// Which of a scan's points tell nothing of walls: they lie on a track that moves.
#include <span>

#include "planner/scan/scan_points.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// Drops the points within a hand of where each of `moving` should be at `stamp`, as seen from `map_from_robot`. Ground
/// that people walk on is free in the map: among many of them a scan would seem to contradict it, though the few walls
/// in between say where the robot is.
void mask_moving_tracks(std::span<const Track> moving, const Pose2& map_from_robot, Time stamp,
                        ScanPoints& points) noexcept;

}  // namespace jaywalk
