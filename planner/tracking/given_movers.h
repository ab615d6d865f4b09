#pragma once
// Mode paper: movers that an outside system names and places.
#include "hal/types/outside_fix.h"
#include "planner/tracking/target.h"

namespace jaywalk {

/// Corrects the bodies that `fix` names, a Kalman filter each, and adds those it names first: `last_id` is the newest
/// track's. Where there is no room, the one farthest from the robot goes. What is no number, or wider than 2 m, is
/// passed over.
void take_given(const OutsideFix& fix, Vec2 robot_in_map, Targets& targets, std::uint32_t& last_id) noexcept;

}  // namespace jaywalk
