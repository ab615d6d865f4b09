#pragma once
// What every reader of recordings checks before it believes a scan or a pose.
#include <limits>
#include <span>
#include <string>

#include "apps/formats/logs/recorded_log.h"

namespace jaywalk::sim {

inline constexpr const char* kTimeStands = "its time does not grow";
inline constexpr const char* kTimeLeapt = "the one before it is ahead of its time";
inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Throws StartupError where the scan's beams, angles or limits make no fan.
void check_scan(const LogPlace& place, const RecordedScan& scan);

/// Takes the last scan back where its stamp alone is more than a second ahead of those before and after it.
void drop_leapt_scan(RecordedLog& log, const LogPlace& place, Time now);

/// Appends `ranges` (m, one a beam) and the scan itself, unless its time does not grow. Readings of `nothing_from_m`,
/// or 1 km, and over become infinite. False when refused. Throws StartupError for a scan more than an hour after the
/// one before.
bool add_scan(RecordedLog& log, const LogPlace& place, RecordedScan scan, std::span<const double> ranges,
              double nothing_from_m);

/// Throws StartupError where no scan was read, naming the first line of `file` that was refused, and where a third of
/// the ranges are over 100 m.
void require_scans(const RecordedLog& log, const std::string& file, const std::string& expected);

/// `pose`, its heading wrapped. Throws StartupError when it is NaN or lies beyond 1000 km.
[[nodiscard]] Pose2 sound_pose(const LogPlace& place, const Pose2& pose);

/// Odometry that may begin anew on its way.
class OdometryPoses {
 public:
  explicit OdometryPoses(RecordedLog& log) : log_(log) {}

  /// A pose as the recording says it. One whose time does not grow is left out and counted; one that lies farther than
  /// a robot drives begins anew there. Throws StartupError for a speed that is none.
  void add(const OdometryPose& said, const LogPlace& place);

 private:
  [[nodiscard]] bool jumps(const OdometryPose& last, const OdometryPose& said) const;

  RecordedLog& log_;
  Pose2 here_from_said_;  ///< from the frame of the poses at hand to that of the first
};

/// Two clocks that were never set by one another give times that do not meet: an error where none of the odometry is of
/// the scans' time, a remark from a second without it on.
void compare_times(RecordedLog& log, const std::string& odometry_name);

}  // namespace jaywalk::sim
