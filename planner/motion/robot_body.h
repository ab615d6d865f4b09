#pragma once
#include <array>
#include <cmath>

#include "hal/types/robot_model.h"
#include "planner/motion/blind_rim.h"
#include "planner/motion/body_discs.h"
#include "planner/motion/body_outline.h"
#include "planner/motion/robot_motion.h"

namespace jaywalk::motion {

/// The robot, as roll-outs need it.
struct RobotBody {
  BodyDiscs to_walls, to_movers;
  BodyOutline outline;              ///< to walls, by a stick or near them: discs reach beyond a body's sides
  std::array<Place, 8> rim{};       ///< corners and the sides' middles, in the robot's frame
  float rim_m = 0.0F;               ///< farthest point from the axle
  bool is_long = false;             ///< not nearly round
  float comfort_distance_m = 1.0F;  ///< from a disc's middle to a mover's: nearer costs
  BlindRim blind;                   ///< where the supervisor lets it go slowly
  MotionBounds bounds;

  /// From the body's edge to a place in its frame, m; 0 inside.
  [[nodiscard]] JAYWALK_ANYWHERE float gap(float ahead, float left) const {
    const float front = rim[0].x, rear = rim[5].x, side = rim[0].y, off = std::fabs(left) - side;
    const float over = ahead > front ? ahead - front : ahead < rear ? rear - ahead : 0.0F;
    const float beside = off > 0.0F ? off : 0.0F;
    return std::sqrt(over * over + beside * beside);
  }
};

/// `comfort_distance_m`: a mover's middle nearer than this to the body's discs costs. Thread: any.
[[nodiscard]] RobotBody robot_body(const Footprint& footprint, const MotionLimits& limits,
                                   const OfEach<LaserModel>& lasers, double comfort_distance_m);

/// No faster than `most_mps` either way, nor than robot_body() has it.
void limit_speed_of(MotionBounds& bounds, const MotionLimits& limits, double most_mps) noexcept;

}  // namespace jaywalk::motion
