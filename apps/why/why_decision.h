#pragma once
#include <string>
#include <vector>

#include "apps/report/picture/scene.h"
#include "planner/motion/goal_rollouts.h"

namespace jaywalk {

/// "follow the way": what a trajectory proposals, as a person says it.
[[nodiscard]] const char* name_of(motion::Proposal proposal);

/// "12.3 s to the goal, 0.4 s of comfort": a cost and its terms worth saying.
[[nodiscard]] std::string in_words(const motion::Cost& cost);

/// The decision as a picture shows it. Throws nothing but std::bad_alloc.
[[nodiscard]] DecisionScene scene_of(const motion::GoalRollouts& motion,
                                     const std::vector<motion::Alternative>& alternatives);

/// A table of everything that a decision weighed, cheapest first: what it proposes, what it costs term by term (s),
/// where it ends. Throws StartupError when the file cannot be made.
void write_alternatives(const std::vector<motion::Alternative>& alternatives, const std::string& file);

}  // namespace jaywalk
