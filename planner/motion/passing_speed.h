#pragma once
#include <span>

#include "planner/motion/speed_choice.h"
#include "planner/tracking/standing_pedestrian.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// The most (m/s, up to the maximum) at which the robot may go on along the way (from the place nearest to it) past
/// what stands there: `standing`, and of `tracks` those that walk and have stopped for now. Beside a pedestrian it goes
/// no faster than it would take a second for the gap between the two, 0.2 m/s at the least, so that it has all but
/// stopped when that sets out; and it slows down in time for that. An empty way slows nothing. Source: our own rule;
/// docs/explanation/algorithm.md, "Speed". Thread: the loop's; never allocates.
[[nodiscard]] double passing_speed(const Way& way, const Pose2& map_from_robot,
                                   std::span<const StandingPedestrian> standing, std::span<const Track> tracks,
                                   const SpeedChoiceConfig& config) noexcept;

}  // namespace jaywalk
