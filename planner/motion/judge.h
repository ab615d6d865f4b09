#pragma once
#include "planner/motion/blind_rim.h"
#include "planner/motion/body_discs.h"
#include "planner/motion/futures.h"
#include "planner/motion/trajectory.h"

namespace jaywalk::motion {

/// The robot, as roll-outs need it.
struct RobotBody {
  BodyDiscs to_walls, to_movers;
  std::array<Place, 8> rim{};  ///< corners and the sides' middles, in the robot's frame
  float rim_m = 0.0F;          ///< farthest point from the axle
  float berth_m = 1.0F;        ///< from a disc's middle to a mover's: nearer costs
  BlindRim blind;              ///< where the supervisor lets it go slowly
  MotionBounds bounds;
};

/// What the trajectories of one decision have in common.
struct Situation {
  const RobotBody& body;
  const Guide& guide;
  const Futures& futures;
  RobotState start;
  Place goal;
  float turned = 0.0F;            ///< the side that it turned to last: turned_side()
  Stay stay;                      ///< where it has been since it last got on
  float arrives_within_m = 0.0F;  ///< of the goal: there
};

/// Drives a trajectory in thought and adds up what it costs. Gives up above `bound` (total() is then more than that,
/// and no more is known). Writes the states after each step to `driven`, unless that is null.
[[nodiscard]] Cost judge(const Situation& situation, const Trajectory& trajectory, float bound,
                         RobotState* driven = nullptr) noexcept;

}  // namespace jaywalk::motion
