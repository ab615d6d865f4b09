#pragma once
#include <array>
#include <cmath>

#include "hal/types/trig.h"
#include "planner/cost_to_go/pose_guide.h"
#include "planner/motion/cost/prices.h"
#include "planner/motion/near_returns.h"
#include "planner/motion/robot_body.h"
#include "planner/motion/trajectory.h"
#include "planner/prediction/futures.h"

namespace jaywalk::motion {

/// So much before the nearest place to the goal the robot may come to rest, m: it slows down so much too early.
inline constexpr float kRestsBefore_m = 0.06F;

/// The stick counts for 3 s: longer than it takes to steer clear, sooner than a person asks for something else. By the
/// end of 5 s every trajectory is at rest, so that what is driven can always be ended without touching anything.
inline constexpr int kFollowedSteps = 30, kStickSteps = 50;
/// States of what the stick asks for, rolled out as if nothing were in the way.
using StickRollout = std::array<RobotState, kFollowedSteps>;

/// Input of a decision besides ground, futures and returns.
struct DecisionInput {
  RobotState start;
  Place goal;
  float turned = 0.0F;                                      ///< the side that it turned to last: turned_side()
  StallState stall = {};                                    ///< for how long it has made no progress
  bool wants_heading = false;                               ///< at the goal
  float goal_heading = 0.0F, faces_rad = price::kFacesRad;  ///< that heading; within so much of it, it is reached
  KnownBehind known_behind = {};                            ///< at the start
};

/// What the trajectories of one decision have in common; each term of the cost reads its part.
struct Situation : DecisionInput {
  const RobotBody& body;
  const Guide& guide;
  const Futures& futures;
  const NearReturns& returns;
  float arrives_within_m = 0.0F;              ///< of the goal: there
  const StickRollout* stick = nullptr;        ///< driven by the stick: nearness to this counts, and no goal
  const PoseGuide* poses = nullptr;           ///< null: the heading counts nowhere
  float conflict_price_s = price::kConflict;  ///< of being in a mover's way

  /// Whether there is a way from poses near the robot.
  [[nodiscard]] bool goes_by_poses() const noexcept { return poses != nullptr && poses->known; }
  [[nodiscard]] bool is_at_goal(const RobotState& at) const noexcept {
    const float dx = goal.x - at.x, dy = goal.y - at.y;
    return dx * dx + dy * dy < arrives_within_m * arrives_within_m;
  }
  /// Whether it stands at the goal once it has slowed down.
  [[nodiscard]] bool rests_at_goal(const RobotState& now) const noexcept {
    return rests_near(now, goal.x, goal.y, arrives_within_m, kRestsBefore_m, body.bounds);
  }
  /// From the heading wanted at the goal, rad.
  [[nodiscard]] float off_heading(float heading) const noexcept {
    return std::fabs(cell::wrapped(goal_heading - heading));
  }
  /// Seconds; Guide::kNoWay_s or more: there is no way.
  [[nodiscard]] float time_to_go(const RobotState& at) const noexcept {
    if (poses != nullptr && poses->goal_closed) return Guide::kNoWay_s;
    const float there =
        goes_by_poses() ? poses->time_to_go(guide, at.x, at.y, at.heading) : guide.time_to_go(at.x, at.y);
    const bool turns = wants_heading && there < Guide::kNoWay_s && !(goes_by_poses() && poses->covers(goal.x, goal.y));
    return turns ? there + turn_there_s(at) : there;
  }

 private:
  /// The turn at the goal, from the direction in which it comes there: without it a trajectory that arrives later would
  /// cost no more, as it turns after its end.
  [[nodiscard]] float turn_there_s(const RobotState& at) const noexcept {
    const auto to_goal =
        static_cast<float>(atan2(static_cast<double>(goal.y - at.y), static_cast<double>(goal.x - at.x)));
    return off_heading(is_at_goal(at) ? at.heading : to_goal) / price::kTurnAtGoalRadps;
  }
};

/// How far off the stick's roll-out a trajectory is, in seconds at full speed: its distance from the place there at
/// the same time, and the radians between the two, averaged over 3 s, times 2. To stand in place of full speed costs
/// about as many seconds as the stick counts for. `states`: of each step, kFollowedSteps at least.
[[nodiscard]] float seconds_off(const StickRollout& asked, const RobotState* states,
                                const MotionBounds& bounds) noexcept;

/// Rolls a trajectory out and adds up what it costs: the sum of the terms in planner/motion/cost/, at the prices of
/// cost/prices.h. Gives up above `bound` (total() is then more than that, and no more is known). Writes the states
/// after each step to `driven`, unless that is null. A new term is one file there, and a line in the sum.
[[nodiscard]] Cost trajectory_cost(const Situation& situation, const Trajectory& trajectory, float bound,
                                   RobotState* driven = nullptr) noexcept;

}  // namespace jaywalk::motion
