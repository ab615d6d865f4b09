#include "planner/motion/make_motion.h"

#include <utility>

#include "planner/motion/goal_rollouts.h"
#include "planner/motion/path_motion.h"
#include "planner/motion/steered_motion.h"

namespace jaywalk::motion {
namespace {

std::unique_ptr<Motion> make_motion_to_goal(const MotionSetup& setup) {
  if (setup.to_goal == MotionKind::kPath) return std::make_unique<PathMotion>(setup);
  return std::make_unique<GoalRollouts>(setup);
}

}  // namespace

std::unique_ptr<Motion> make_motion(const MotionSetup& setup) {
  std::unique_ptr<Motion> to_goal = make_motion_to_goal(setup);
  if (setup.steering == StickUse::kNone) return to_goal;
  return std::make_unique<SteeredMotion>(setup, std::move(to_goal));
}

}  // namespace jaywalk::motion
