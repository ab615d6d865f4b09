#pragma once
// How a robot that cannot ask its wheels goes on: as it went from scan to scan.
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Learns speed and turn from where matches put the robot, and says how far it has come since. Thread: the loop's.
class Coasting {
 public:
  /// A way, and how far off that may be, as standard deviations (m an axis, rad).
  struct Step {
    Pose2 before_from_after;
    double metres_std = 0.0, radians_std = 0.0;
  };

  /// At constant speed, off by what a wheelchair can accelerate by; for longer than three seconds it is taken to have
  /// stood, and may be anywhere. Nothing before the first scan (`from` kNever), and when time went backwards.
  [[nodiscard]] Step step(Time from, Time to) const noexcept;
  /// A match put it there; what no wheelchair can drive makes its speed unknown: zero.
  void placed(const Pose2& map_from_robot, Time stamp) noexcept;
  /// Nothing matched, and it is believed there: the speed is believed a little less.
  void not_placed(const Pose2& map_from_robot, Time stamp) noexcept;
  /// Ahead and turning: what of its speed the wheels would tell.
  [[nodiscard]] Twist2 twist() const { return {velocity_in_robot_.x, turn_radps_}; }

 private:
  Pose2 last_;
  Time last_stamp_ = kNever;
  Vec2 velocity_in_robot_;
  double turn_radps_ = 0.0;
};

}  // namespace jaywalk
