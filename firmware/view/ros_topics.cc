#include "firmware/view/ros_topics.h"

#include <cmath>

#include "firmware/exchange/ros_messages.h"
#include "firmware/exchange/ros_schemas.h"

namespace jaywalk::view {
namespace {

constexpr Duration kMapEvery = std::chrono::seconds(2);
constexpr Duration kDiagnosticsEvery = std::chrono::milliseconds(100);

enum Channel : std::size_t { kScan, kPoints, kOdom, kTf, kMap, kPlan, kGoal, kTracks, kDiagnostics, kCmdVel };

constexpr std::uint32_t bit(Channel channel) { return 1U << channel; }

bool same_heading(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

std::vector<FoxgloveChannel> RosTopics::channels() {
  std::vector<FoxgloveChannel> all{{"/scan", "sensor_msgs/msg/LaserScan", ""},
                                   {"/points", "sensor_msgs/msg/PointCloud2", ""},
                                   {"/odom", "nav_msgs/msg/Odometry", ""},
                                   {"/tf", "tf2_msgs/msg/TFMessage", ""},
                                   {"/map", "nav_msgs/msg/OccupancyGrid", ""},
                                   {"/plan", "nav_msgs/msg/Path", ""},
                                   {"/goal_pose", "geometry_msgs/msg/PoseStamped", ""},
                                   {"/tracks", "visualization_msgs/msg/MarkerArray", ""},
                                   {"/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", ""},
                                   {"/cmd_vel", "geometry_msgs/msg/Twist", ""}};
  for (FoxgloveChannel& channel : all) channel.schema = exchange::ros_schema(channel.type);
  return all;
}

void RosTopics::forget(std::uint32_t channels) {
  if ((channels & (bit(kScan) | bit(kPoints) | bit(kTracks))) != 0) scan_seen_ = 0;
  if ((channels & bit(kPlan)) != 0) plan_seen_ = 0;
  if ((channels & bit(kGoal)) != 0) goal_seen_ = {};
  if ((channels & bit(kMap)) != 0) mapped_ = kNever;
}

void RosTopics::add(const ViewSnapshot& snapshot, const RobotModel& model, std::uint32_t wanted) {
  forget(wanted & ~wanted_);
  wanted_ = wanted;
  if (wanted == 0) return;
  const TickRecord& t = snapshot.record;
  const auto wants = [wanted](Channel channel) { return (wanted & bit(channel)) != 0; };
  if (wants(kTf)) push_(kTf, t.now, exchange::transforms(t, model.laser.robot_from_laser));
  if (wants(kOdom)) push_(kOdom, t.now, exchange::odometry(t, model.drive));
  if (wants(kCmdVel)) push_(kCmdVel, t.now, exchange::command(t));
  if (t.scan.sequence != scan_seen_ && t.scan.beam_count > 0) add_scan(snapshot, wanted);
  if (wants(kPlan) && snapshot.plan.sequence != plan_seen_ && snapshot.plan.status == PlanStatus::kOk) {
    push_(kPlan, t.now, exchange::path(snapshot.plan));
    plan_seen_ = snapshot.plan.sequence;
  }
  add_goal(t, wanted);
  if (wants(kDiagnostics) && (told_ == kNever || age(told_, t.now) >= kDiagnosticsEvery)) {
    push_(kDiagnostics, t.now, exchange::diagnostics(t));
    told_ = t.now;
  }
}

void RosTopics::add_scan(const ViewSnapshot& snapshot, std::uint32_t wanted) {
  const TickRecord& t = snapshot.record;
  scan_seen_ = t.scan.sequence;
  if ((wanted & bit(kScan)) != 0) push_(kScan, t.now, exchange::laser_scan(t.scan));
  if ((wanted & bit(kPoints)) != 0) push_(kPoints, t.now, exchange::points(t.scan));
  if ((wanted & bit(kTracks)) != 0)
    push_(kTracks, t.now, exchange::tracks({snapshot.tracks.begin(), snapshot.tracks.size()}, t.now));
}

void RosTopics::add_goal(const TickRecord& t, std::uint32_t wanted) {
  const OperatorInput &now = t.input, &before = goal_seen_;
  const bool same =
      now.goal_in_map == before.goal_in_map && same_heading(now.goal_heading_rad, before.goal_heading_rad);
  if (now.has_goal && (wanted & bit(kGoal)) != 0 && !(before.has_goal && same))
    push_(kGoal, t.now, exchange::goal_pose(t));
  goal_seen_ = now;
}

bool RosTopics::is_map_due(Time now, std::uint32_t wanted) const {
  return (wanted & bit(kMap)) != 0 && (mapped_ == kNever || age(mapped_, now) >= kMapEvery);
}

void RosTopics::add_map(const EvidenceMap& map, Time now) {
  push_(kMap, now, exchange::occupancy(map, now));
  mapped_ = now;
}

}  // namespace jaywalk::view
