#pragma once
// How a robot without wheels to ask goes on: as it went from scan to scan.
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Learns speed and turn from where matches put the robot, and says how far it has come since. Thread: the loop's.
class Coasting {
 public:
  /// The way since the last scan, and how far off that may be, as standard deviations (m an axis, rad).
  struct Step {
    Pose2 before_from_after;
    double metres_std = 0.0, radians_std = 0.0;
  };

  /// At constant speed, within what a wheelchair can accelerate by; after a longer gap than a second it is taken to
  /// have stood, and before the first scan and when time went backwards.
  [[nodiscard]] Step since_last_scan(Time stamp) const noexcept;
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
