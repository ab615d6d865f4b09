#pragma once
// Beams that end on the robot itself: masts, cables, a rider's feet.
#include <array>
#include <bitset>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// Learns them: a range that stays the same under turn after turn of the robot is fixed to it. Only ranges below 1 m
/// are asked; turns are asked for because a wall that the robot drives along stays as near as it was, and other
/// headings than the last few, because it is as near again when the robot sways. What lies near the middle of a turn is
/// not asked: a pedestrian that the robot drives round stays as near, too.
class SelfMask {
 public:
  explicit SelfMask(const Pose2& robot_from_laser) : robot_from_laser_(robot_from_laser) {}

  /// Takes a scan and the pose that it was seen from.
  void learn(const LaserScan& scan, const Pose2& map_from_robot) noexcept;
  /// Whether what `beam` ends on at `range_m` is the robot's: not what stands before it, nor what is seen beyond it.
  [[nodiscard]] bool on_robot(std::size_t beam, double range_m) const noexcept;
  /// Whether `beam` has never measured anything, be it that nothing is in reach, at so many headings: the robot, or the
  /// scanner's own housing, is before it.
  [[nodiscard]] bool blocked(std::size_t beam) const noexcept { return asked_ >= kEnough && !measured_[beam]; }

 private:
  static constexpr std::uint8_t kEnough = 4;

  std::bitset<kMaxBeams> measured_;
  std::array<float, kMaxBeams> range_m_{};
  std::array<std::uint8_t, kMaxBeams> agreed_{};  ///< headings that gave range_m_ again, less those that did not
  Pose2 robot_from_laser_;
  std::array<Pose2, kEnough> asked_at_{};  ///< one after the other, round and round
  std::size_t last_asked_ = 0;
  std::uint32_t asked_ = 0;  ///< headings so far, up to kEnough
};

}  // namespace jaywalk
