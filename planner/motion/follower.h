#pragma once
#include <limits>
#include <span>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "planner/motion/footprint_guide.h"
#include "planner/motion/goal_turn.h"
#include "planner/motion/pursuit.h"
#include "planner/motion/speed_choice.h"
#include "planner/motion/twist_ramp.h"
#include "planner/tracking/stander.h"
#include "planner/tracking/track.h"
#include "planner/planner.h"

namespace jaywalk {

struct FollowerConfig {
  MotionLimits limits;
  RobotShape robot{.radius_m = 0.3};  ///< SpeedChoiceConfig's
  bool stands_at_worst = false;       ///< the same
  bool constant_speed = false;        ///< the paper's constraint: one speed from start to goal, never stopping
  double goal_tolerance_m = 0.3;
  double tick_s = 0.02;
};

/// What the follower looks at this tick.
struct FollowerInput {
  const Path& path;  ///< may be empty: then it slows to a stop (or, at constant speed, keeps its course)
  Pose2 map_from_robot;
  Vec2 goal_in_map;
  bool has_goal = false;
  std::span<const Track> tracks;                                    ///< all of them: see choose_speed
  std::span<const Stander> standing = {};                           ///< see passing_speed
  double most_speed_mps = std::numeric_limits<double>::infinity();  ///< beside the robot's own limit
  Twist2 permitted_before;                                          ///< what the supervisor made of the last wish
  FootprintGuide* guide = nullptr;  ///< of a body that is longer than wide; null: the path fits everywhere
  GoalTurn* turn = nullptr;         ///< to the heading wanted at the goal; null: none can be
};

/// From a path to the twist that the robot would like: pure pursuit, with a speed that curves, the goal and people
/// allow, ramped within the comfort limits. Thread: the loop's; never allocates.
class Follower {
 public:
  explicit Follower(const FollowerConfig& config);
  [[nodiscard]] Twist2 twist(const FollowerInput& input) noexcept;

 private:
  [[nodiscard]] Twist2 wish(const FollowerInput& input) noexcept;
  [[nodiscard]] Twist2 braked_hard(const Twist2& before) const noexcept;
  [[nodiscard]] Twist2 at_goal(const FollowerInput& input) const noexcept;
  [[nodiscard]] Twist2 manoeuvre(const FollowerInput& input, ManoeuvreDrive& drive) const noexcept;
  [[nodiscard]] double among_people(const Way& way, const FollowerInput& input) const noexcept;
  [[nodiscard]] double speed_for(const FollowerInput& input, double curvature_per_m) const noexcept;

  FollowerConfig config_;
  SpeedChoiceConfig speed_choice_;
  TwistRamp ramp_;
};

}  // namespace jaywalk
