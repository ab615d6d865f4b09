#pragma once
// The topics of a run, for everything that shows one: the MCAP export, the live stream, the bridge to DDS.
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/recording/tick_record.h"
#include "hal/types/robot_model.h"
#include "planner/localization/odometry.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/track.h"

namespace jaywalk::exchange {

/// The robot's pose in odometry, and odometry's pose in the map (the odometry frame drifts).
struct RobotFrames {
  Pose2 map_from_odom, odom_from_robot;
};

/// sensor_msgs/LaserScan. A beam that measured and found nothing is +inf, one that knows nothing NaN (REP 117).
[[nodiscard]] std::string laser_scan(const LaserScan& scan, Time stamp, const std::string& frame);
/// `word`, or `word`_front and so on of one of several scanners.
[[nodiscard]] std::string of_scanner(const std::string& word, const RobotModel& model, std::size_t scanner);

/// The definition of a ROS 2 message type ("sensor_msgs/msg/LaserScan") and of all types in it, as MCAP's ros2msg wants
/// it. Field names and types are those of ROS 2 Humble. Throws std::out_of_range for a type that is not among them.
[[nodiscard]] std::string ros_schema(const std::string& type);

struct RosTopic {
  const char* name;
  const char* type;
  bool latched = false;  ///< kept for readers that come later: durability transient local
};

/// A topic's number is its place in kRosTopics.
enum RosTopicNumber : std::uint8_t {
  kScan,
  kPoints,
  kOdom,
  kTf,
  kMap,
  kPlan,
  kGoal,
  kTracks,
  kDiagnostics,
  kCmdVel,
  kTfStatic,
  kClock
};

inline constexpr std::array<RosTopic, 12> kRosTopics{{{"/scan", "sensor_msgs/msg/LaserScan"},
                                                      {"/points", "sensor_msgs/msg/PointCloud2"},
                                                      {"/odom", "nav_msgs/msg/Odometry"},
                                                      {"/tf", "tf2_msgs/msg/TFMessage"},
                                                      {"/map", "nav_msgs/msg/OccupancyGrid", true},
                                                      {"/plan", "nav_msgs/msg/Path"},
                                                      {"/goal_pose", "geometry_msgs/msg/PoseStamped"},
                                                      {"/tracks", "visualization_msgs/msg/MarkerArray"},
                                                      {"/diagnostics", "diagnostic_msgs/msg/DiagnosticArray"},
                                                      {"/cmd_vel", "geometry_msgs/msg/Twist"},
                                                      {"/tf_static", "tf2_msgs/msg/TFMessage", true},
                                                      {"/clock", "rosgraph_msgs/msg/Clock"}}};
/// First number of a robot's other scanners' scans.
inline constexpr std::size_t kOtherScans = kRosTopics.size();

struct NamedTopic {
  std::string name;  ///< "/scan_front" where there are several scanners
  std::string type;
};
/// All topics of a run with this robot. A topic's index is its number.
[[nodiscard]] std::vector<NamedTopic> topics_of(const RobotModel& model);

/// A run's ticks as ROS 2's messages (docs/reference/outputs.md says when there is one of which topic). Each message is
/// made only where its topic is wanted. Thread: one.
class RosTopics {
 public:
  /// A message in CDR of the topic of that number.
  using Push = std::function<void(std::size_t topic, Time stamp, std::string message)>;
  static constexpr std::uint32_t kAllTopics = ~0U;

  /// `unix_from_loop` is added to all stamps.
  explicit RosTopics(Push push, Duration unix_from_loop = Duration{0})
      : push_(std::move(push)), unix_from_loop_(unix_from_loop) {}

  /// A tick, what was tracked in it and the newest plan's path, with no points where there is none or it was told
  /// before. `wanted`: a bit a topic. A topic that was not wanted before is told whatever it last said.
  void add(const TickRecord& t, std::span<const Track> tracks, const PlannedPath& path, const RobotModel& model,
           std::uint32_t wanted = kAllTopics);
  /// Whether the map is due: every two seconds.
  [[nodiscard]] bool is_map_due(Time now, std::uint32_t wanted = kAllTopics) const;
  void add_map(const EvidenceMap& map, Time now);

 private:
  void forget(std::uint32_t topics);
  [[nodiscard]] bool wants(std::size_t topic) const { return (wanted_ >> topic & 1U) != 0; }
  [[nodiscard]] Time wall(Time loop) const { return loop + unix_from_loop_; }
  /// Sends the message that `write` makes of `parts`, where its topic is wanted.
  template <class Write, class... Parts>
  void say(RosTopicNumber topic, Time time, Write write, const Parts&... parts);
  [[nodiscard]] RobotFrames frames_at(const TickRecord& t, const RobotModel& model);
  void add_scans(const TickRecord& t, std::span<const Track> tracks, const RobotModel& model);
  void add_goal(const TickRecord& t);
  void add_diagnostics(const TickRecord& t);

  Push push_;
  Duration unix_from_loop_;
  std::optional<Odometry> odometry_;
  bool told_static_ = false;
  std::uint32_t wanted_ = 0;                               ///< last time
  std::array<std::uint32_t, kMostScanners> scans_seen_{};  ///< of each scanner
  OperatorInput goal_seen_;
  Reason reasons_ = Reason::kNone;
  Time plan_seen_ = kNever, mapped_ = kNever, told_ = kNever;
};

}  // namespace jaywalk::exchange
