#pragma once
#include "planner/motion/motion.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk::paper {

/// Which point of the path is nearest to `place`, the first of equals. The path is not empty.
[[nodiscard]] std::size_t nearest_point(const Path& path, Vec2 place) noexcept;

/// The point of the path `ahead_m` of arc length beyond the point nearest to `robot`; the last one where the path ends
/// before. The path is not empty.
[[nodiscard]] Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept;

/// How to steer for the point that a robot at `v_mps` (0 or more) looks at. The path is not empty.
struct Steering {
  double bearing = 0.0;          ///< of that point (rad, left positive)
  double curvature_per_m = 0.0;  ///< of the circle through it that is tangent to the heading
  /// It lies so far aside that the robot turns on the spot before it drives.
  [[nodiscard]] bool turns_first() const noexcept;
  /// Turning on the spot (rad/s), at most `most_radps`.
  [[nodiscard]] double turn_radps(double most_radps) const noexcept;
  /// Turning (rad/s) on the circle at `v_mps`, at most `most_radps`.
  [[nodiscard]] double circle_radps(double v_mps, double most_radps) const noexcept;
};
[[nodiscard]] Steering pursue(const Path& path, const Pose2& map_from_robot, double v_mps) noexcept;

/// Follows the plan's path at constant speed, never stopping: the paper's experiment. Pure pursuit, ramped within the
/// comfort limits; without a path it goes straight on, without a goal it comes to rest.
class PathMotion final : public motion::Motion {
 public:
  explicit PathMotion(const motion::MotionSetup& setup);

  void observe(const motion::World& world, const motion::Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const motion::World& world, const motion::Intent& intent) noexcept override;
  void decide(const motion::World&, const motion::Intent&) noexcept override {}
  [[nodiscard]] motion::MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const motion::World& world) const noexcept override;

 private:
  [[nodiscard]] Twist2 target(const motion::World& world, const motion::Intent& intent) const noexcept;

  MotionLimits limits_;
  double tick_s_;
  TwistRamp ramp_;
  motion::MotionStatus status_;
};

}  // namespace jaywalk::paper
