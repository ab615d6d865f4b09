#pragma once
// A tick as ROS 2's messages, in CDR. Frames: "map", "base_link" (the drive axle's middle), "laser". Stamps are the
// loop's clock; in a simulation it begins at 0.
#include <span>
#include <string>

#include "firmware/recording/tick_record.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/track.h"

namespace jaywalk::exchange {

/// sensor_msgs/LaserScan. A beam that measured and found nothing is +inf, one that knows nothing NaN (REP 117).
[[nodiscard]] std::string laser_scan(const LaserScan& scan);
/// sensor_msgs/PointCloud2 of the hits, in the laser's frame.
[[nodiscard]] std::string points(const LaserScan& scan);
/// nav_msgs/Odometry: the estimated pose in the map, the wheels' own speed.
[[nodiscard]] std::string odometry(const TickRecord& tick, const DriveModel& drive);
/// tf2_msgs/TFMessage: map to base_link, base_link to laser.
[[nodiscard]] std::string transforms(const TickRecord& tick, const Pose2& robot_from_laser);
/// geometry_msgs/Twist: what the supervisor permitted.
[[nodiscard]] std::string command(const TickRecord& tick);
/// geometry_msgs/PoseStamped.
[[nodiscard]] std::string goal_pose(const TickRecord& tick);
/// nav_msgs/Path.
[[nodiscard]] std::string path(const PlannedPath& path);
/// visualization_msgs/MarkerArray: a cylinder a track, red where it moves.
[[nodiscard]] std::string tracks(std::span<const Track> tracks, Time stamp);
/// diagnostic_msgs/DiagnosticArray: reasons, plan, gap.
[[nodiscard]] std::string diagnostics(const TickRecord& tick);
/// nav_msgs/OccupancyGrid of what is known: 100 occupied, 0 seen free, -1 unknown.
[[nodiscard]] std::string occupancy(const EvidenceMap& map, Time stamp);

}  // namespace jaywalk::exchange
