#include "planner/motion/make_motion.h"

#include <utility>

#include "planner/motion/goal_rollouts.h"
#include "planner/motion/leaving_motion.h"
#include "planner/motion/long_body_motion.h"
#include "planner/motion/path_motion.h"
#include "planner/motion/steered_motion.h"
#include "planner/motion/turning_motion.h"

namespace jaywalk::motion {
namespace {

std::unique_ptr<Motion> make_motion_to_goal(const MotionSetup& setup) {
  switch (setup.to_goal) {
    case MotionKind::kPath:
      return std::make_unique<PathMotion>(setup);
    case MotionKind::kLongBody:
      return std::make_unique<LongBodyMotion>(setup);
    case MotionKind::kRollouts:
      break;
  }
  return turning_at_goal(setup, std::make_unique<GoalRollouts>(setup));
}

}  // namespace

std::unique_ptr<Motion> make_motion(const MotionSetup& setup) {
  std::unique_ptr<Motion> to_goal = make_motion_to_goal(setup);
  if (!setup.constant_speed) to_goal = std::make_unique<LeavingMotion>(setup, std::move(to_goal));
  if (setup.steering == StickUse::kNone) return to_goal;
  return std::make_unique<SteeredMotion>(setup, std::move(to_goal));
}

std::unique_ptr<Motion> turning_at_goal(const MotionSetup& setup, std::unique_ptr<Motion> to_goal) {
  if (setup.constant_speed) return to_goal;
  return std::make_unique<TurningMotion>(setup, std::move(to_goal));
}

}  // namespace jaywalk::motion
