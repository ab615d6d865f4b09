#include "planner/motion/motion.h"

#include <utility>

#include "planner/motion/goal_rollouts.h"
#include "planner/motion/stick_rollouts.h"

namespace jaywalk::motion {

std::unique_ptr<Motion> make_motion(const MotionSetup& setup) {
  auto to_goal = std::make_unique<GoalRollouts>(setup);
  if (setup.steering == StickUse::kNone) return to_goal;
  return std::make_unique<SteeredMotion>(setup, std::move(to_goal));
}

}  // namespace jaywalk::motion
