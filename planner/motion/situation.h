#pragma once
#include "planner/motion/near_returns.h"
#include "planner/motion/robot_body.h"
#include "planner/motion/stick_proposals.h"
#include "planner/motion/trajectory.h"
#include "planner/prediction/futures.h"

namespace jaywalk::motion {

/// What the trajectories of one decision have in common.
struct Situation {
  const RobotBody& body;
  const Guide& guide;
  const Futures& futures;
  const NearReturns& returns;
  RobotState start;
  Place goal;
  float turned = 0.0F;                  ///< the side that it turned to last: turned_side()
  StallState stall;                     ///< where it has been since it last made progress
  float arrives_within_m = 0.0F;        ///< of the goal: there
  const StickRollout* stick = nullptr;  ///< driven by the stick: nearness to this counts, and no goal
};

}  // namespace jaywalk::motion
