#pragma once
// The paper's door: the planner and the follower of mode paper.
#include <memory>

#include "planner/motion/motion.h"
#include "planner/paper/paper_request.h"

namespace jaywalk::paper {

/// Plans by the potential among marks, on the CPU: status and path are theirs. Throws StartupError for a configuration
/// that makes no sense.
[[nodiscard]] std::unique_ptr<Planner> make_cpu_paper_planner(const PaperConfig& config);

/// Follows the plan's path at constant speed, never stopping.
[[nodiscard]] std::unique_ptr<motion::Motion> make_motion(const motion::MotionSetup& setup);

}  // namespace jaywalk::paper
