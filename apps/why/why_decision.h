#pragma once
#include <string>
#include <vector>

#include "apps/report/picture/scene.h"
#include "planner/motion/motion_planner.h"

namespace jaywalk {

/// "follow the way": what a trajectory attempts, as a person says it.
[[nodiscard]] const char* name_of(motion::Attempt attempt);

/// "12.3 s to the goal, 0.4 s of comfort": a cost and its terms worth saying.
[[nodiscard]] std::string in_words(const motion::Cost& cost);

/// The decision as a picture shows it. Throws nothing but std::bad_alloc.
[[nodiscard]] DecisionScene scene_of(const motion::MotionPlanner& motion,
                                     const std::vector<motion::Alternative>& alternatives);

/// A table of everything that a decision weighed, cheapest first: what it attempts, what it costs term by term (s),
/// where it ends. Throws StartupError when the file cannot be made.
void write_alternatives(const std::vector<motion::Alternative>& alternatives, const std::string& file);

}  // namespace jaywalk
