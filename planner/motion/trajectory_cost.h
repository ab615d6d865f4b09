#pragma once
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// Rolls a trajectory out and adds up what it costs: the sum of the terms in planner/motion/cost/, at the prices of
/// cost/prices.h. Gives up above `bound` (total() is then more than that, and no more is known). Writes the states
/// after each step to `driven`, unless that is null. A new term is one file there, and a line in the sum.
[[nodiscard]] Cost trajectory_cost(const Situation& situation, const Trajectory& trajectory, float bound,
                                   RobotState* driven = nullptr) noexcept;

}  // namespace jaywalk::motion
