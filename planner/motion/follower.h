#pragma once
#include <limits>
#include <span>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "planner/motion/goal_turn.h"
#include "planner/motion/manoeuvre_drive.h"
#include "planner/motion/motion.h"
#include "planner/motion/speed_choice.h"
#include "planner/motion/twist_ramp.h"
#include "planner/planner.h"
#include "planner/tracking/standing_pedestrian.h"
#include "planner/tracking/track.h"

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
  std::span<const StandingPedestrian> standing = {};                ///< see passing_speed
  double most_speed_mps = std::numeric_limits<double>::infinity();  ///< beside the robot's own limit
  Twist2 permitted_before;                                          ///< what the supervisor made of the last command
};
[[nodiscard]] FollowerInput follower_input(const motion::World& world, const motion::Intent& intent) noexcept;

/// From a path, a manoeuvre or a turn to the twist that the robot would like, ramped within the comfort limits: pure
/// pursuit, with a speed that curves, the goal and people allow. Thread: the loop's; never allocates.
class Follower {
 public:
  explicit Follower(const FollowerConfig& config);

  /// Along the path, no faster than `most_body_mps` for the body's sake.
  [[nodiscard]] Twist2 along_path(const FollowerInput& input,
                                  double most_body_mps = std::numeric_limits<double>::infinity()) noexcept;
  [[nodiscard]] Twist2 along(ManoeuvreDrive& drive, const FollowerInput& input) noexcept;
  /// At the goal: to the heading wanted there.
  [[nodiscard]] Twist2 turning(GoalTurn& turn, const FollowerInput& input) noexcept;
  /// As hard as the drives were proved to, on the same arc: for what would be touched within comfort.
  [[nodiscard]] Twist2 braking_hard(const FollowerInput& input) noexcept;
  [[nodiscard]] Twist2 to_rest(const FollowerInput& input) noexcept { return ramped({}, input); }

  /// There is a path, and the goal is not reached; at constant speed it never is.
  [[nodiscard]] bool is_under_way(const FollowerInput& input) const noexcept;

 private:
  [[nodiscard]] Twist2 ramped(const Twist2& target, const FollowerInput& input) noexcept;
  [[nodiscard]] double among_people(const Way& way, const FollowerInput& input) const noexcept;
  [[nodiscard]] double speed_for(const FollowerInput& input, double curvature_per_m,
                                 double most_body_mps) const noexcept;

  FollowerConfig config_;
  SpeedChoiceConfig speed_choice_;
  TwistRamp ramp_;
};

}  // namespace jaywalk
