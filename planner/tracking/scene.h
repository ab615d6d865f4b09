#pragma once
// One scan taken apart.
#include "planner/scan/segments.h"
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

}  // namespace jaywalk
