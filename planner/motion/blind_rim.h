#pragma once
#include <algorithm>
#include <vector>

#include "hal/types/robot_model.h"
#include "planner/motion/robot_motion.h"
#include "planner/motion/trajectory.h"

namespace jaywalk::motion {

/// The parts of the body's outline beside which no laser ever looks. The supervisor lets such a part move outward at
/// 0.3 m/s at most (firmware/safety/blind_gaps.cc); a roll-out that counts on more would be braked.
///
/// Memory in the constructor. Thread: any.
class BlindRim {
 public:
  BlindRim() = default;
  /// Beside points every 5 cm. Blanked sectors are left to the supervisor.
  BlindRim(const Footprint& footprint, const OfEach<LaserModel>& lasers);

  /// By how much (m/s) the fastest of them is too fast when the robot drives at `v` m/s and turns at `w` rad/s; 0 when
  /// none is.
  [[nodiscard]] float too_fast(float v, float w) const noexcept;
  /// The same way on, as fast as is permitted: both parts of the command in proportion, as the supervisor does it.
  [[nodiscard]] Command slowed(const Command& command) const noexcept;
  /// The same speed, with the turn as near to `w` as is permitted: while a ramped speed still falls, the turn waits for
  /// it, or the supervisor would brake both. `w` as it is where `v` alone is too fast.
  [[nodiscard]] float turn_at(float v, float w) const noexcept;
  /// Whether no laser looks at all that lies straight behind the robot.
  [[nodiscard]] bool is_behind() const noexcept { return too_fast(-1.0F, 0.0F) > 0.0F; }
  [[nodiscard]] std::size_t points() const noexcept { return points_.size(); }

 private:
  struct Point {
    float x, y;          ///< in the robot's frame
    float out_x, out_y;  ///< outward, both components at a corner
  };
  std::vector<Point> points_;
  float reach_m_ = 0.0F;  ///< of the farthest from the axle
};

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
