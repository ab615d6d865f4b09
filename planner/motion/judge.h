#pragma once
#include "planner/prediction/futures.h"
#include "planner/motion/near_returns.h"
#include "planner/motion/robot_body.h"
#include "planner/motion/trajectory.h"
#include "planner/motion/wish.h"

namespace jaywalk::motion {

/// What the trajectories of one decision have in common.
struct Situation {
  const RobotBody& body;
  const Guide& guide;
  const Futures& futures;
  const NearReturns& returns;
  RobotState start;
  Place goal;
  float turned = 0.0F;              ///< the side that it turned to last: turned_side()
  Stay stay;                        ///< where it has been since it last got on
  float arrives_within_m = 0.0F;    ///< of the goal: there
  const WishedWay* wish = nullptr;  ///< a person steers: nearness to this counts, and no goal
};

/// Drives a trajectory in thought and adds up what it costs. Gives up above `bound` (total() is then more than that,
/// and no more is known). Writes the states after each step to `driven`, unless that is null.
[[nodiscard]] Cost judge(const Situation& situation, const Trajectory& trajectory, float bound,
                         RobotState* driven = nullptr) noexcept;

}  // namespace jaywalk::motion
