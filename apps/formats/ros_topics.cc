#include "apps/formats/ros_topics.h"

#include <cmath>

namespace jaywalk::exchange {
namespace {

constexpr Duration kMapEvery = std::chrono::seconds(2);
constexpr Duration kDiagnosticsEvery = std::chrono::milliseconds(100);

constexpr std::uint32_t bit(RosTopicNumber topic) { return 1U << topic; }

bool same_heading(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

std::vector<NamedTopic> topics_of(const RobotModel& model) {
  std::vector<NamedTopic> topics;
  for (const RosTopic& topic : kRosTopics) topics.push_back({topic.name, topic.type});
  topics[kScan].name = of_scanner("/scan", model, 0);
  for (std::size_t k = 1; k < model.lasers().size(); ++k)
    topics.push_back({of_scanner("/scan", model, k), kRosTopics[kScan].type});
  return topics;
}

void RosTopics::forget(std::uint32_t topics) {
  if ((topics & (bit(kScan) | bit(kPoints) | bit(kTracks))) != 0) scan_seen_ = 0;
  if ((topics & bit(kPlan)) != 0) plan_seen_ = kNever;
  if ((topics & bit(kGoal)) != 0) goal_seen_ = {};
  if ((topics & bit(kMap)) != 0) mapped_ = kNever;
  if ((topics & bit(kTfStatic)) != 0) told_static_ = false;
}

/// Without wheels odom is the map.
RobotFrames RosTopics::frames_at(const TickRecord& t, const RobotModel& model) {
  if (!odometry_) odometry_.emplace(model.drive);
  if (t.wheels.sequence == 0) return {{}, t.pose.map_from_robot};
  if (t.wheels.stamp != odometry_->stamp()) (void)odometry_->take(t.wheels);
  const Pose2 odom_from_robot = odometry_->odom_from_robot();
  return {t.pose.map_from_robot * inverse(odom_from_robot), odom_from_robot};
}

void RosTopics::add(const TickRecord& t, std::span<const Track> tracks, const PlannedPath& path,
                    const RobotModel& model, std::uint32_t wanted) {
  forget(wanted & ~wanted_);
  wanted_ = wanted;
  if (wanted == 0) return;
  const auto wants = [wanted](RosTopicNumber topic) { return (wanted & bit(topic)) != 0; };
  const Time now = wall(t.now);
  const RobotFrames frames = frames_at(t, model);
  if (wants(kTfStatic) && !std::exchange(told_static_, true)) push_(kTfStatic, now, static_transforms(model, now));
  if (wants(kClock)) push_(kClock, now, clock(now));
  if (wants(kTf)) push_(kTf, now, transforms(frames, now));
  if (wants(kOdom)) push_(kOdom, now, odometry(frames, t.wheels, model.drive, now));
  if (wants(kCmdVel)) push_(kCmdVel, now, command(t));
  if (t.scan.sequence != scan_seen_ && t.scan.beam_count > 0) add_scan(t, tracks, model, wanted);
  add_other_scans(t, model, wanted);
  if (wants(kPlan) && !path.points.empty() && path.stamp != plan_seen_) {
    push_(kPlan, now, exchange::path(path, wall(path.stamp)));
    plan_seen_ = path.stamp;
  }
  add_goal(t, wanted);
  if (wants(kDiagnostics)) add_diagnostics(t);
}

void RosTopics::add_scan(const TickRecord& t, std::span<const Track> tracks, const RobotModel& model,
                         std::uint32_t wanted) {
  const std::string frame = of_scanner("laser", model, 0);
  scan_seen_ = t.scan.sequence;
  const Time now = wall(t.now), taken = wall(t.scan.stamp);
  if ((wanted & bit(kScan)) != 0) push_(kScan, now, laser_scan(t.scan, taken, frame));
  if ((wanted & bit(kPoints)) != 0) push_(kPoints, now, points(t.scan, taken, frame));
  if ((wanted & bit(kTracks)) != 0) push_(kTracks, now, exchange::tracks(tracks, now));
}

void RosTopics::add_other_scans(const TickRecord& t, const RobotModel& model, std::uint32_t wanted) {
  for (std::size_t k = 0; k < t.other_scans.size(); ++k) {
    const LaserScan& scan = t.other_scans[k];
    const bool is_new = std::exchange(others_seen_[k], scan.sequence) != scan.sequence && scan.beam_count > 0;
    if (is_new && (wanted & (1U << (kOtherScans + k))) != 0)
      push_(kOtherScans + k, wall(t.now), laser_scan(scan, wall(scan.stamp), of_scanner("laser", model, k + 1)));
  }
}

void RosTopics::add_goal(const TickRecord& t, std::uint32_t wanted) {
  const OperatorInput &now = t.input, &before = goal_seen_;
  const bool same =
      now.goal_in_map == before.goal_in_map && same_heading(now.goal_heading_rad, before.goal_heading_rad);
  if (now.has_goal && (wanted & bit(kGoal)) != 0 && !(before.has_goal && same))
    push_(kGoal, wall(t.now), goal_pose(now, wall(t.now)));
  goal_seen_ = now;
}

void RosTopics::add_diagnostics(const TickRecord& t) {
  const bool is_due = told_ == kNever || age(told_, t.now) >= kDiagnosticsEvery;
  if (!is_due && t.verdict.reasons == reasons_) return;
  push_(kDiagnostics, wall(t.now), diagnostics(t, wall(t.now)));
  reasons_ = t.verdict.reasons;
  told_ = t.now;
}

bool RosTopics::is_map_due(Time now, std::uint32_t wanted) const {
  return (wanted & bit(kMap)) != 0 && (mapped_ == kNever || age(mapped_, now) >= kMapEvery);
}

void RosTopics::add_map(const EvidenceMap& map, Time now) {
  std::string message = occupancy(map, wall(now));
  if (message.empty()) return;
  push_(kMap, wall(now), std::move(message));
  mapped_ = now;
}

}  // namespace jaywalk::exchange
