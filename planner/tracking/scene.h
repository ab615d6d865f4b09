#pragma once
// One scan taken apart, without the beams that end on the robot itself (masts, cables, a rider's feet).
#include <array>
#include <bitset>
#include <cstdint>
#include <span>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"
#include "planner/tracking/detection.h"
#include "planner/tracking/target.h"

namespace jaywalk {
/// Beams that end on the robot itself, learnt: a range that stays the same under turn after turn is fixed to it. Only
/// ranges below 1 m are asked; turns are asked for because a wall that the robot drives along stays as near as it was,
/// and other headings than the last few, because it is as near again when the robot sways. What lies near the middle of
/// a turn is not asked: a pedestrian that the robot drives round stays as near, too.
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

/// What the newest scan shows, in the robot's frame and in the map, and the memory that takes. Thread: the loop's.
class Scene : public ScanPieces {
 public:
  explicit Scene(const Pose2& mount) : robot_from_laser(mount), self_mask_(mount) {}

  /// Points, cut where the scan jumps and where known `targets` touch, and the pieces that may be bodies; points on the
  /// robot itself are left out. `still` is the map from all scans before. The rest: as Tracker::update() has it.
  void update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, const EvidenceMap& still,
              const Targets& targets) noexcept;

  Pose2 robot_from_laser, map_from_laser;
  ScanPoints empty;  ///< ends of beams without a return, cut at kObservedM or at kSeesAll of the reach
  Detections detections;

 private:
  void drop_own_points(const LaserScan& scan) noexcept;
  void project_empty_beams(const LaserScan& scan, const Twist2& twist) noexcept;
  [[nodiscard]] bool ends_on_robot(const LaserScan& scan, std::uint32_t beam) const noexcept;

  SelfMask self_mask_;
  ScanProjection projection_;
};

/// Decides what the points of the scan that `detections` were found in and `targets` were seen by may become in the
/// map. What moves, or has come to ground that was free and has not settled, becomes nothing. What is as wide as
/// people, seen whole on ground of which nothing is known, may be a standing pedestrian: no wall until it has been
/// known for three seconds.
void decide_entries(const Targets& targets, const Detections& detections, std::span<const Vec2> points_in_map,
                    const EvidenceMap& still, Time now, Entries& out) noexcept;

}  // namespace jaywalk
