#pragma once
// One scan taken apart.
#include <span>

#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"
#include "planner/scan/self_mask.h"
#include "planner/tracking/detection.h"
#include "planner/tracking/target.h"

namespace jaywalk {

/// What the newest scan shows, in the robot's frame and in the map, and the memory that takes. Thread: the loop's.
class Scene {
 public:
  explicit Scene(const Pose2& robot_from_laser) : robot_from_laser_(robot_from_laser), self_mask_(robot_from_laser) {}

  /// Points, cut where the scan jumps and where known `targets` touch, and the pieces that may be bodies; points on the
  /// robot itself are left out. `still` is the map from all scans before. The rest: as Tracker::update() has it.
  void update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, const EvidenceMap& still,
              const Targets& targets) noexcept;

  Pose2 map_from_laser;
  ScanPoints points;
  ScanPoints empty;    ///< ends of beams without a return, cut at kObservedM or at kSeesAll of the reach
  PointsInMap in_map;  ///< of as many points
  Detections detections;

 private:
  void drop_own_points(const LaserScan& scan, const Sweep& sweep) noexcept;
  void project_empty_beams(const LaserScan& scan, const Twist2& twist) noexcept;
  [[nodiscard]] bool ends_on_robot(const LaserScan& scan, std::uint32_t beam) const noexcept;

  Pose2 robot_from_laser_;
  SelfMask self_mask_;
  ScanProjection projection_;
  Segments segments_;
};

// What a scan's points may become in the map: walls, but for those of bodies.

/// Decides for the points of the scan that `detections` were found in and `targets` were seen by. What moves, or
/// has come to ground that was free and has not settled, becomes nothing. What is as wide as people, seen whole on
/// ground of which nothing is known, may be a standing pedestrian: no wall until it has been known for three seconds.
void decide_entries(const Targets& targets, const Detections& detections, std::span<const Vec2> points_in_map,
                    const EvidenceMap& still, Time now, Entries& out) noexcept;

}  // namespace jaywalk
