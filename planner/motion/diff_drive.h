#pragma once
#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Wheel speeds for a twist: each wheel's rim moves at v -+ w b/2 (b: track width).
/// When a wheel would be faster than the motors can turn, both slow by the same factor, so that the robot keeps its
/// curve and only takes longer. A twist that is not finite gives zero.
class DiffDrive {
 public:
  explicit DiffDrive(const DriveModel& drive) : drive_(drive) {}
  [[nodiscard]] WheelCommand wheel_speeds(const Twist2& twist, Time stamp) const noexcept;

 private:
  DriveModel drive_;
};

}  // namespace jaywalk
