#pragma once
#include "planner/cost_to_go/pose_guide.h"
#include "planner/motion/cost/prices.h"
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
  const PoseGuide* poses = nullptr;     ///< null: the heading counts nowhere
  float goal_heading = 0.0F;            ///< wanted at the goal, where `wants_heading`
  bool wants_heading = false;
  float conflict_price_s = price::kConflict;  ///< of being in a mover's way

  [[nodiscard]] bool is_long() const noexcept { return body.is_long && poses != nullptr; }
  /// Whether there is a way from poses near the robot.
  [[nodiscard]] bool goes_by_poses() const noexcept { return poses != nullptr && poses->known; }
  [[nodiscard]] float time_to_go(const RobotState& at) const noexcept {
    return goes_by_poses() ? poses->time_to_go(guide, at.x, at.y, at.heading) : guide.time_to_go(at.x, at.y);
  }
};

}  // namespace jaywalk::motion
