#pragma once
#include "apps/rivals/baseline.h"
#include "planner/cell/circle.h"

namespace jaywalk::baseline {

/// The direction in which the time to the goal falls fastest within half a metre of a place, past walls; straight to
/// the goal where nothing is known or it is that near.
[[nodiscard]] cell::Heading way_down(const Scene& scene) noexcept;

/// The speed, m/s, at which the robot may still come to rest at the goal.
[[nodiscard]] float speed_to_goal(const Scene& scene) noexcept;

/// Drives a holonomic velocity: in T it brings the robot to where the velocity leads, on an arc (Alonso-Mora and others
/// 2013, section 3); beyond a right angle it turns on the spot.
[[nodiscard]] motion::Command driven_along(const Scene& scene, cell::Heading direction, float speed) noexcept;

}  // namespace jaywalk::baseline
