#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hal/types/geometry.h"

namespace jaywalk {

/// Poses of the robot along a constant twist, one for every 4 cm that the fastest-moving part of its footprint goes.
class SweptPath {
 public:
  static constexpr double kStep_m = 0.04;  ///< half a 70 mm cylinder and a bit: none slips between two steps
  static constexpr std::size_t kMostSteps = 512;
  static constexpr double kLongest_m = kStep_m * kMostSteps;

  /// `rim_mps`: speed of the fastest-moving part, above 0; `length_m`: how far that goes, kLongest_m at most.
  SweptPath(const Twist2& twist, double rim_mps, double length_m) noexcept
      : steps_(std::min(static_cast<std::size_t>(std::min(length_m, kLongest_m) / kStep_m) + 1, kMostSteps)) {
    const double step_s = kStep_m / rim_mps;
    // Driving a chord and then turning differs from the arc by less than 0.3 mm a step.
    const double ahead_m = twist.v_mps * step_s;
    const Vec2 turn = direction(twist.w_radps * step_s);
    poses_[0] = {{}, {1.0, 0.0}};
    for (std::size_t k = 0; k < steps_; ++k) {
      const Pose& before = poses_[k];
      const Vec2 ahead = before.axis;
      poses_[k + 1] = {before.position + ahead * ahead_m,
                       {ahead.x * turn.x - ahead.y * turn.y, ahead.y * turn.x + ahead.x * turn.y}};
    }
  }

  [[nodiscard]] std::size_t steps() const noexcept { return steps_; }
  /// A place of the robot's frame at the start, as the robot sees it after step k of steps().
  [[nodiscard]] Vec2 seen_from(std::size_t k, Vec2 place) const noexcept {
    const Vec2 d = place - poses_[k].position;
    return {dot(poses_[k].axis, d), cross(poses_[k].axis, d)};
  }
  /// Where a point of the robot's is after step k of steps(), in the robot's frame at the start.
  [[nodiscard]] Vec2 place_of(std::size_t k, Vec2 point) const noexcept {
    const Vec2 axis = poses_[k].axis;
    return poses_[k].position + Vec2{axis.x * point.x - axis.y * point.y, axis.y * point.x + axis.x * point.y};
  }

 private:
  struct Pose {
    Vec2 position;
    Vec2 axis;  ///< unit vector of the heading
  };
  std::size_t steps_;
  std::array<Pose, kMostSteps + 1> poses_;
};

}  // namespace jaywalk
