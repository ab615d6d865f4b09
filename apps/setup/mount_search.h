#pragma once
#include <functional>
#include <optional>

#include "apps/formats/logs/recorded_log.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What localisation knows at a tick of a recording.
struct LivedTick {
  Time now;
  Pose2 map_from_robot;
  Time scan_stamp;  ///< of the newest scan
  Pose2 map_from_robot_at_scan;
};
/// Localisation and tracking live through a recording, by its wheels where it has them, until `visit` says false.
void live_through(const sim::RecordedLog& log, const std::function<bool(const LivedTick&)>& visit);

/// The yaw (rad) of the laser of a recording that says nothing of it, found by matching: localisation and tracking live
/// through the first 20 m of the recording's way, the yaw that MountCheck misses is added, and so on until less than
/// 0.02 rad is missing, seven times at most. Where the laser stands on the robot is not found. Nothing: it looks where
/// the wheels drive, within 0.1 rad; or there are no wheels, too short a way, or no yaw explains what is seen.
[[nodiscard]] std::optional<double> found_mount_yaw(const sim::RecordedLog& log);

/// Does the laser look where the wheels drive? A differential drive cannot slip sideways for long: when the poses that
/// scans and wheels agree upon keep sliding to one side, the laser's yaw is not the one in the robot file.
class MountCheck {
 public:
  /// The estimated pose at each tick, in order.
  void add(const Pose2& map_from_robot);
  /// The direction (rad) that it slid to, 0 ahead and rising to the left, when it drove at least 5 m.
  [[nodiscard]] std::optional<double> slide() const;
  /// The yaw (rad) that robot_from_laser lacks, when it slid by more than kTells_rad; its estimate rests on poses that
  /// the wrong mount had a part in: more may be missing once it is added.
  [[nodiscard]] std::optional<double> missing_yaw() const;

  static constexpr double kTells_rad = 0.1;

 private:
  bool begun_ = false;
  Pose2 before_;
  Vec2 driven_in_robot_;  ///< sum of the steps, each in the robot's frame of its time (m)
};

}  // namespace jaywalk
