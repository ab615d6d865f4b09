#pragma once
// Beams that end on the robot itself: masts, cables, a rider's feet.
#include <array>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// Learns them: a range that stays the same under turn after turn of the robot is fixed to it. Only ranges below 1 m
/// are asked; turns are asked for because a wall that the robot drives along stays as near as it was.
class SelfMask {
 public:
  /// Takes a scan and the heading it was seen from.
  void learn(const LaserScan& scan, double heading_rad) noexcept;
  [[nodiscard]] bool on_robot(std::size_t beam) const { return agreed_[beam] >= kEnough; }

 private:
  static constexpr std::uint8_t kEnough = 4;

  std::array<float, kMaxBeams> range_m_{};
  std::array<std::uint8_t, kMaxBeams> agreed_{};  ///< headings that gave range_m_ again, less those that did not
  double asked_at_rad_ = 0.0;
};

}  // namespace jaywalk
