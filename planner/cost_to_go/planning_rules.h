#pragma once
// The planner's rules of thumb, each with its reason, and what it refuses.
#include "planner/cost_to_go/planner.h"

namespace jaywalk::field {

/// A robot that stands in an obstacle or its inflation starts from the nearest free cell this near.
inline constexpr double kStartRadius_m = 1.0;
/// A goal that is not free is replaced by the nearest cell this near that the robot can reach.
inline constexpr double kGoalRadius_m = 0.5;
/// Radius within which unseen places count as walls for a body that must not back into them.
inline constexpr double kUnseenRadius_m = 2.0;

/// Throws StartupError for a configuration that makes no sense.
void check(const PlannerConfig& config);
/// The error of one value.
[[noreturn]] void refuse(const char* name, double value, const char* remedy);

/// True where pose, goal and speed are numbers.
[[nodiscard]] bool is_finite(const PlanRequest& request) noexcept;

}  // namespace jaywalk::field
