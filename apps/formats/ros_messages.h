#pragma once
// A tick as ROS 2's messages, in CDR. Frames by REP 105: "map", "odom", "base_link" (the drive axle's middle), "laser";
// of several lasers "laser_front" and so on.
// Each message's stamp is given.
#include <span>
#include <string>

#include "firmware/recording/tick_record.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/track.h"

namespace jaywalk::exchange {

/// Where the robot is: its wheels' own frame drifts against the map.
struct RobotFrames {
  Pose2 map_from_odom, odom_from_robot;
};

/// sensor_msgs/LaserScan. A beam that measured and found nothing is +inf, one that knows nothing NaN (REP 117).
[[nodiscard]] std::string laser_scan(const LaserScan& scan, Time stamp, const std::string& frame = "laser");
/// sensor_msgs/PointCloud2 of the hits, in the laser's frame.
[[nodiscard]] std::string points(const LaserScan& scan, Time stamp, const std::string& frame = "laser");
/// nav_msgs/Odometry: the wheels' pose in odom, and their speed.
[[nodiscard]] std::string odometry(const RobotFrames& frames, const WheelState& wheels, const DriveModel& drive,
                                   Time stamp);
/// tf2_msgs/TFMessage: map to odom, odom to base_link.
[[nodiscard]] std::string transforms(const RobotFrames& frames, Time stamp);
/// tf2_msgs/TFMessage: base_link to each laser.
[[nodiscard]] std::string static_transforms(const RobotModel& model, Time stamp);
/// `word`, or `word`_front and so on of one of several scanners.
[[nodiscard]] std::string of_scanner(const std::string& word, const RobotModel& model, std::size_t scanner);
/// geometry_msgs/Twist: what the supervisor permitted.
[[nodiscard]] std::string command(const TickRecord& tick);
/// geometry_msgs/PoseStamped.
[[nodiscard]] std::string goal_pose(const OperatorInput& input, Time stamp);
/// nav_msgs/Path.
[[nodiscard]] std::string path(const PlannedPath& path, Time stamp);
/// visualization_msgs/MarkerArray: a cylinder a track, red where it moves, and a line ("expected") to where it will be
/// in 2.5 s if it goes straight on.
[[nodiscard]] std::string tracks(std::span<const Track> tracks, Time stamp);
/// rosgraph_msgs/Clock.
[[nodiscard]] std::string clock(Time now);
/// diagnostic_msgs/DiagnosticArray: reasons, plan, gap.
[[nodiscard]] std::string diagnostics(const TickRecord& tick, Time stamp);
/// nav_msgs/OccupancyGrid of what is known: 100 occupied, 0 seen free, -1 unknown.
[[nodiscard]] std::string occupancy(const EvidenceMap& map, Time stamp);

/// The definition of a ROS 2 message type ("sensor_msgs/msg/LaserScan") and of all types in it, as MCAP's ros2msg wants
/// it. Field names and types are those of ROS 2 Humble. Throws std::out_of_range for a type that is not among them.
[[nodiscard]] std::string ros_schema(const std::string& type);

}  // namespace jaywalk::exchange
