#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// The raw scans of the last second, of all scanners: whether a place was free a moment ago, whatever the map makes of
/// it. A thing that walks stands where beams passed; one that only comes into view, or shows another side, does not.
/// Memory in the constructor. Thread: the loop's.
class PastScans {
 public:
  PastScans() : kept_(std::make_unique<std::array<Kept, kMost>>()) {}
  /// `scan`, taken by the laser at `robot_from_laser` of a robot that was at `map_from_robot` and moved with `twist`.
  /// Scans of one scanner that come sooner than kApart are left out.
  void keep(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser,
            const Twist2& twist) noexcept;
  /// Share, 0 to 1, of the looks at these places, in the map, that went through, of all that told anything, in scans
  /// taken kUntil to kSince before `now`; none where none told.
  [[nodiscard]] std::optional<double> seen_through(std::span<const Vec2> places, Time now) const noexcept;

 private:
  static constexpr std::size_t kMost = 16;
  struct Kept {
    LaserScan scan;
    Pose2 map_from_robot, robot_from_laser;
    Twist2 twist;
  };
  std::unique_ptr<std::array<Kept, kMost>> kept_;
  std::size_t count_ = 0;  ///< that were ever kept
};

}  // namespace jaywalk
