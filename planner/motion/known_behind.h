#pragma once
#include <algorithm>

#include "planner/motion/robot_motion.h"
#include "planner/motion/trajectory.h"

namespace jaywalk::motion {

/// How far the robot may back at its speed though nothing looks there: what it has driven forward, less what it has
/// backed since. At rest it shrinks by its greatest length a second: a pedestrian may step behind the robot. Beyond it
/// the robot backs slowly (docs/explanation/decisions/motion-backward.md).
class KnownBehind {
 public:
  KnownBehind() = default;
  explicit KnownBehind(bool is_blind) : is_blind_(is_blind) {}

  void drive(float v_mps, float for_s) noexcept {
    const float gained_mps = std::fabs(v_mps) < kRestsMps ? -kMost_m : v_mps;
    left_m_ = std::clamp(left_m_ + gained_mps * for_s, 0.0F, kMost_m);
  }

  [[nodiscard]] MotionBounds limited(MotionBounds bounds) const noexcept {
    if (is_blind_ && left_m_ <= 0.0F) bounds.back = std::min(bounds.back, kBeyondMps);
    return bounds;
  }

 private:
  static constexpr float kMost_m = 0.5F, kBeyondMps = 0.12F;
  bool is_blind_ = false;
  float left_m_ = 0.0F;
};

}  // namespace jaywalk::motion
