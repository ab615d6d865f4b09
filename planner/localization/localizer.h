#pragma once
// Where the robot is: wheels, scans matched to the map, fixes from outside.
#include <memory>
#include <span>

#include "hal/types/laser_scan.h"
#include "hal/types/outside_fix.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/track.h"

namespace jaywalk {
struct LocalizationConfig {
  Pose2 map_from_robot_at_start;
  DriveModel drive;
  Pose2 robot_from_laser;
  bool match_scans = true;
  bool doubts = true;  ///< PoseDoubt is told; false for a log, in which no person can say where the robot is
  OfOthers<Pose2> robot_from_others{};  ///< the other lasers' mounts
};

/// Pose and how sure we are of it, at `stamp`.
struct PoseEstimate {
  Time stamp = kNever;
  Pose2 map_from_robot;
  double position_std_m = 0.0;
  double heading_std_rad = 0.0;
  bool doubtful = false;  ///< the pose is lost (PoseDoubt)
};

/// Thread: the loop's. The constructor allocates; update() never does, and never throws.
class Localizer {
 public:
  explicit Localizer(const LocalizationConfig& config);
  ~Localizer();

  /// Once for each scanner's newest scan, in the order of their stamps. Moves the estimate on by the wheels' newest
  /// reading; a scan with a new sequence number is matched against `still`
  /// (when it holds enough, which among walkers must have stood for a second), but for what lies on tracks that
  /// were `moving` when the scan before was seen; a fix with a new one is blended by variance, if its stamp is
  /// no older than the poses that are remembered, nor yet to come, and it is no mistake (FixGate). Without wheels
  /// (sequence 0 for ever), and while they are silent, scans alone carry the pose.
  [[nodiscard]] const PoseEstimate& update(const WheelState& wheels, const LaserScan& scan, const OutsideFix& fix,
                                           const EvidenceMap& still, std::span<const Track> moving) noexcept;

  /// Puts the pose in doubt until a fix: the robot was carried.
  void carried() noexcept;

  /// The pose at the stamp of a scanner's newest scan: what the tracker wants.
  [[nodiscard]] Pose2 map_from_robot_at_scan(std::size_t scanner = 0) const noexcept;
  /// Speed as the wheels (or, without them, the scans) say.
  [[nodiscard]] const Twist2& twist() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace jaywalk
