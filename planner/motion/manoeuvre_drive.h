#pragma once
#include "hal/types/robot_model.h"
#include "planner/motion/body_map.h"
#include "planner/motion/manoeuvre.h"
#include "planner/motion/way.h"

namespace jaywalk {

/// Drives a manoeuvre pose by pose, stopping where the gear changes. Knows how far it has come; thread: the loop's.
class ManoeuvreDrive {
 public:
  explicit ManoeuvreDrive(const MotionLimits& limits) : limits_(limits) {}

  /// kHeld: wheels straight, no correction.
  enum class Steering { kFree, kHeld };
  /// kOnward: its last piece, where that leads forward, is left at speed, for the path goes on from there.
  enum class End { kOnward, kAtRest };
  void begin(const Manoeuvre& manoeuvre, Steering steering = Steering::kFree, End end = End::kOnward) noexcept;
  void stop() noexcept { at_ = 0, manoeuvre_.clear(); }
  [[nodiscard]] bool active() const noexcept { return at_ < manoeuvre_.size(); }

  /// The twist that keeps to the manoeuvre from here, not ramped; zero when there is nothing left of it.
  [[nodiscard]] Twist2 command(const Pose2& map_from_robot) noexcept;
  /// For looking out for movers on it.
  [[nodiscard]] Way way() const noexcept { return {.places = places_, .looking = &looking_}; }
  /// How far (m) the robot is from where it should be.
  [[nodiscard]] double off_by(const Pose2& map_from_robot) const noexcept;
  /// Least clearance (m) of the poses that are left.
  [[nodiscard]] double clearance_left(const BodyMap& map) const noexcept;
  /// What of it is enough to go on: `margin_m`, or a centimetre less than it had where it began.
  [[nodiscard]] double least_kept_m(double margin_m) const noexcept;

 private:
  [[nodiscard]] std::size_t end_of_gear() const noexcept;
  [[nodiscard]] Twist2 turn(const Pose2& here) noexcept;
  [[nodiscard]] Twist2 drive(const Pose2& here) noexcept;

  MotionLimits limits_;
  Manoeuvre manoeuvre_;
  Path places_, looking_;
  Steering steering_ = Steering::kFree;
  End end_ = End::kOnward;
  std::size_t at_ = 0;  ///< the step on the way to which it is
};

}  // namespace jaywalk
